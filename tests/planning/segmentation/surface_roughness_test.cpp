#include "planning/segmentation/surface_roughness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planning/phantom/phantom_knee.h"

namespace arthronaut::segmentation {
namespace {

// The built-in femur is smooth at 5 mm; what moves its vertices along their normals is found again: the fit
// takes up 6 of the patch's many numbers, and nothing of what changes from one to the next.
TEST(SurfaceRoughness, IsWhatMovesTheVerticesOfASmoothBone) {
  const geometry::TriangleMesh smooth = phantom::make_phantom_knee().femur.mesh;
  EXPECT_LT(roughness_mm(smooth), 0.1);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 0.5);
  geometry::TriangleMesh ragged = smooth;
  const auto normals = geometry::vertex_normals(smooth);
  for (std::size_t v = 0; v < ragged.vertices_mm.size(); ++v)
    ragged.vertices_mm[v] += normal(random) * normals[v];
  EXPECT_NEAR(roughness_mm(ragged), 0.5, 0.1);
}

TEST(SurfaceRoughness, OfAnEmptyMeshIsNothing) { EXPECT_EQ(roughness_mm({}), 0); }

}  // namespace
}  // namespace arthronaut::segmentation
