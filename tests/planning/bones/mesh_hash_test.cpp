#include "planning/bones/mesh_hash.h"

#include <gtest/gtest.h>

namespace arthronaut::bones {

namespace {

TEST(MeshHash, TellsMeshesApart) {
  const geometry::TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}}};
  geometry::TriangleMesh moved = mesh, rewired = mesh;
  moved.vertices_mm[3].z() += 1e-9;
  rewired.triangles[1] = {1, 3, 0};
  EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(geometry::TriangleMesh(mesh)));
  EXPECT_NE(mesh_sha256(mesh), mesh_sha256(moved));
  EXPECT_NE(mesh_sha256(mesh), mesh_sha256(rewired));
  EXPECT_EQ(mesh_sha256(mesh).size(), 64U);
}

}  // namespace

}  // namespace arthronaut::bones
