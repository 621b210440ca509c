#include "navigation/registration/bone/distance_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/geometry/triangle_distance.h"
#include "tests/navigation/registration/phantom_bone.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::registration {

namespace {

// A cube of side 20 mm about the origin: sharp edges, where signs go wrong first.
geometry::TriangleMesh cube() { return test::box(Eigen::Vector3d::Constant(10)); }

double distance_to_cube(const Eigen::Vector3d& p) {
  const Eigen::Vector3d q = p.cwiseAbs().array() - 10;
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

}  // namespace

// Sign and distance about a cube's faces, edges and corners; the interpolant rounds creases off by up to half
// a cell.
TEST(DistanceField, CubeHasExactSignsAtEdgesAndCorners) {
  const DistanceField field(cube());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-13, 13);
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Vector3d p(uniform(random), uniform(random), uniform(random));
    const double truth = distance_to_cube(p);
    if (std::abs(truth) > field.band_mm() - 1) continue;
    EXPECT_NEAR(field.sample(p).distance_mm, truth, 0.3) << p.transpose();
  }
}

// Beyond the band the field is saturated, with the right sign.
TEST(DistanceField, SaturatesBeyondTheBand) {
  const DistanceField field(cube());
  EXPECT_DOUBLE_EQ(field.sample({0, 0, 0}).distance_mm, -field.band_mm());
  EXPECT_DOUBLE_EQ(field.sample({500, 0, 0}).distance_mm, field.band_mm());
  EXPECT_EQ(field.sample({500, 0, 0}).gradient.norm(), 0);
  EXPECT_DOUBLE_EQ(
      field.sample(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())).distance_mm,
      field.band_mm());
}

// Against the exact surface of a bone: never another sign where it matters, rounding of the grid in the mean.
TEST(DistanceField, BoneAgreesWithTheExactSurface) {
  const PhantomBone& bone = phantom_bone();
  const DistanceField field(bone.mesh);
  const CoarseDistanceField coarse(field);
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, 1.2);
  double sum = 0, coarse_sum = 0;
  constexpr int kCount = 4000;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d p = bone.mesh.vertices_mm[random() % bone.mesh.vertices_mm.size()] +
                              Eigen::Vector3d(normal(random), normal(random), normal(random));
    const double truth = bone.surface->signed_distance_mm(p);
    const double found = field.sample(p).distance_mm;
    if (std::abs(truth) > 0.2) {
      EXPECT_EQ(found > 0, truth > 0) << truth << " at " << p.transpose();
    }
    EXPECT_NEAR(found, truth, 0.2);
    sum += std::abs(found - truth);
    coarse_sum += std::abs(static_cast<double>(coarse.nearest_mm(p.cast<float>())) - truth);
  }
  EXPECT_LT(sum / kCount, 0.01);
  EXPECT_LT(coarse_sum / kCount, 0.35);
}

// Nearest points by region, against the best of a fine sampling of the triangle.
TEST(TriangleDistance, NearestPointIsNoFartherThanAnySample) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Eigen::Vector3d(uniform(random), uniform(random), uniform(random)); };
  for (int i = 0; i < 300; ++i) {
    const std::array<Eigen::Vector3d, 3> corners{vector(), vector(), vector()};
    const Eigen::Vector3d query = 2 * vector();
    const geometry::NearestOnTriangle found = geometry::nearest_on_triangle(query, corners);
    double best = 1e9;
    for (int u = 0; u <= 40; ++u) {
      for (int v = 0; u + v <= 40; ++v) {
        const double a = u / 40.0, b = v / 40.0;
        best = std::min(best,
                        (query - ((1 - a - b) * corners[0] + a * corners[1] + b * corners[2])).squaredNorm());
      }
    }
    EXPECT_LE(found.squared_mm2, best + 1e-12);
    EXPECT_NEAR(std::sqrt(found.squared_mm2), std::sqrt(best), 0.05);
    EXPECT_NEAR((query - found.point_mm).squaredNorm(), found.squared_mm2, 1e-12);
  }
}

// A mesh that is none is refused.
TEST(DistanceField, RefusesEmptyAndBrokenMeshes) {
  EXPECT_THROW(DistanceField{geometry::TriangleMesh{}}, InvalidInput);
  geometry::TriangleMesh broken = cube();
  broken.vertices_mm[3].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(DistanceField{broken}, InvalidInput);
}

}  // namespace arthronaut::registration
