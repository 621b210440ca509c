#include "planning/geometry/triangle_mesh.h"

#include <gtest/gtest.h>

#include "planning/geometry/rigid_transform.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::geometry {
namespace {

TEST(TriangleMesh, BoxHasItsVolumeAreaAndBounds) {
  TriangleMesh mesh = test::box({30, 20, 10});
  EXPECT_NEAR(signed_volume_mm3(mesh), 60.0 * 40 * 20, 1e-6);
  EXPECT_NEAR(surface_area_mm2(mesh), 2.0 * (60 * 40 + 40 * 20 + 60 * 20), 1e-6);
  EXPECT_NEAR((bounds_of(mesh).size_mm() - Eigen::Vector3d(60, 40, 20)).norm(), 0, 1e-12);
  EXPECT_NEAR(bounds_of(mesh).center_mm().norm(), 0, 1e-12);
  // Turned inside out, the volume changes its sign and nothing else.
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(signed_volume_mm3(mesh), -60.0 * 40 * 20, 1e-6);
}

// The volume does not depend on where the origin is.
TEST(TriangleMesh, VolumeOfAClosedMeshIsTranslationInvariant) {
  const double here = signed_volume_mm3(test::ellipsoid({40, 30, 25}, 3));
  const double there = signed_volume_mm3(test::ellipsoid({40, 30, 25}, 3, {500, -300, 200}));
  EXPECT_NEAR(here, there, 1e-5);
  // Facets cut about 2 % off the ellipsoid at this fineness.
  EXPECT_NEAR(here, 4.0 / 3 * kPi * 40 * 30 * 25, 0.02 * here);
}

TEST(TriangleMesh, VertexNormalsOfASpherePointOutwards) {
  const TriangleMesh mesh = test::ellipsoid({30, 30, 30}, 3);
  const auto normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    EXPECT_LT(deg_from_rad(angle_between_rad(normals[v], mesh.vertices_mm[v])), 2.0);
    EXPECT_NEAR(normals[v].norm(), 1, 1e-12);
  }
}

TEST(TriangleMesh, VertexWithoutTrianglesHasNoNormal) {
  TriangleMesh mesh = test::box({1, 1, 1});
  mesh.vertices_mm.emplace_back(9, 9, 9);
  EXPECT_EQ(vertex_normals(mesh).back().norm(), 0);
}

}  // namespace
}  // namespace arthronaut::geometry
