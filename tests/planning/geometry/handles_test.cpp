#include "planning/geometry/handles.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <map>

#include "planning/geometry/rigid_transform.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::geometry {
namespace {

using Eigen::Vector3i;

// The surface of all cells of 1 mm that are filled; none may touch another at an edge or a corner alone.
TriangleMesh of_cells(const Vector3i& size, const std::function<bool(int x, int y, int z)>& is_filled) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::int32_t> index;
  const auto vertex = [&](const Vector3i& at) {
    const auto [found, is_new] =
        index.try_emplace({at.x(), at.y(), at.z()}, static_cast<std::int32_t>(mesh.vertices_mm.size()));
    if (is_new) mesh.vertices_mm.push_back(at.cast<double>());
    return found->second;
  };
  const auto holds = [&](const Vector3i& c) {
    return (c.array() >= 0).all() && (c.array() < size.array()).all() && is_filled(c.x(), c.y(), c.z());
  };
  for (int x = 0; x < size.x(); ++x)
    for (int y = 0; y < size.y(); ++y)
      for (int z = 0; z < size.z(); ++z) {
        const Vector3i cell(x, y, z);
        if (!holds(cell)) continue;
        for (int axis = 0; axis < 3; ++axis)
          for (const int side : {0, 1}) {
            if (holds(cell + (2 * side - 1) * Vector3i::Unit(axis))) continue;
            const Vector3i u = Vector3i::Unit((axis + 1) % 3), v = Vector3i::Unit((axis + 2) % 3),
                           corner = cell + side * Vector3i::Unit(axis);
            std::array<std::int32_t, 4> c{vertex(corner), vertex(corner + u), vertex(corner + u + v),
                                          vertex(corner + v)};
            if (side == 0) std::swap(c[1], c[3]);
            mesh.triangles.push_back({c[0], c[1], c[2]});
            mesh.triangles.push_back({c[0], c[2], c[3]});
          }
      }
  return mesh;
}

// A block of 30 x 30 x 12 mm with square holes through it: a wide and a narrow one.
TriangleMesh block(bool has_wide, bool has_narrow) {
  return of_cells({30, 30, 12}, [&](int x, int y, int) {
    const bool in_wide = has_wide && x >= 4 && x < 11 && y >= 4 && y < 11,
               in_narrow = has_narrow && x >= 20 && x < 22 && y >= 20 && y < 22;
    return !in_wide && !in_narrow;
  });
}

TEST(Handles, ABallHasNone) {
  EXPECT_TRUE(handles_of(test::ellipsoid({40, 30, 25}, 3), 0).empty());
  EXPECT_TRUE(handles_of(block(false, false), 0).empty());
}

// Round the hole is the shortest way, as the block is thicker than that nowhere.
TEST(Handles, AHoleIsMeasuredAround) {
  const TriangleMesh mesh = block(true, false);
  const auto handles = handles_of(mesh, 16);
  ASSERT_EQ(handles.size(), 1U);
  EXPECT_GT(handles[0].around_mm, 20);  // a diagonal cuts off the corners
  EXPECT_LE(handles[0].around_mm, 28);
  for (const Eigen::Vector3d& p : handles[0].line_mm) {
    EXPECT_NEAR(p.x(), 7.5, 3.6);
    EXPECT_NEAR(p.y(), 7.5, 3.6);
  }
}

// What is too narrow for a tunnel does not hide the one that is there, nor is it taken for one.
TEST(Handles, ANarrowHoleIsLeftOut) {
  EXPECT_EQ(handles_of(block(true, true), 16).size(), 1U);
  EXPECT_TRUE(handles_of(block(false, true), 16).empty());
  EXPECT_EQ(handles_of(block(true, true), 0).size(), 2U);
}

// A thin bridge over a wide gap is a handle as well; what was drilled is not told by the gap alone.
TEST(Handles, AThinBridgeIsLeftOut) {
  const TriangleMesh mesh = of_cells({30, 12, 20}, [](int x, int y, int z) {
    const bool is_bridge = z >= 14 && z < 16 && y >= 5 && y < 7;
    return z < 4 || (z < 16 && (x < 4 || x >= 26)) || is_bridge;
  });
  EXPECT_TRUE(handles_of(mesh, 16).empty());
  EXPECT_EQ(handles_of(mesh, 0).size(), 1U);
}

// A blind hole, an inner cavity and a surface that is not closed.
TEST(Handles, WhatDoesNotGoThroughIsNone) {
  const TriangleMesh blind = of_cells(
      {20, 20, 12}, [](int x, int y, int z) { return !(x >= 6 && x < 14 && y >= 6 && y < 14 && z >= 4); });
  EXPECT_TRUE(handles_of(blind, 0).empty());
  const TriangleMesh hollow = of_cells({20, 20, 12}, [](int x, int y, int z) {
    return !(x >= 6 && x < 14 && y >= 6 && y < 14 && z >= 4 && z < 8);
  });
  EXPECT_TRUE(handles_of(hollow, 0).empty());
  TriangleMesh open = block(true, false);
  open.triangles.pop_back();
  EXPECT_TRUE(handles_of(open, 0).empty());
}

}  // namespace
}  // namespace arthronaut::geometry
