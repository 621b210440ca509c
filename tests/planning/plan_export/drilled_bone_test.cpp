#include "planning/plan_export/drilled_bone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "planning/bones/mesh_repair.h"
#include "planning/geometry/rigid_transform.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/planning/plan_export/exported_case.h"

namespace arthronaut::plan_export {
namespace {

using bones::BoneKind;
using Eigen::Vector3d;

// A hole of 8 mm through a slab of 20 mm takes away pi 4^2 20 mm^3; the drill has the circle's area.
TEST(DrilledBone, TakesACylinderOutOfASlab) {
  const auto slab = test::box({30, 30, 10});
  const tunnels::Tunnel tunnel{BoneKind::Femur, {0.3, -0.2, 10}, -Vector3d::UnitZ(), 8};
  const auto drilled = drill(slab, tunnel);
  ASSERT_TRUE(drilled.is_usable()) << drilled.reason;
  const double removed = geometry::signed_volume_mm3(slab) - geometry::signed_volume_mm3(drilled.mesh);
  EXPECT_NEAR(removed, geometry::kPi * 16 * 20, 0.01);
  EXPECT_TRUE(bones::mend_mesh(drilled.mesh).report.is_closed);
  EXPECT_EQ(drill(slab, {BoneKind::Femur, {0, 0, 60}, Vector3d::UnitZ(), 8}).outcome,
            DrilledBone::Outcome::MissesTheBone);
  auto open = slab;
  open.triangles.pop_back();
  EXPECT_EQ(drill(open, tunnel).outcome, DrilledBone::Outcome::BrokenSurface);
}

// Of 275,000 triangles each edge in the box about a side as long as the tunnel was tried against it: 14 s of
// 16 that an export took.
TEST(DrilledBone, ATunnelsWallIsInShortPieces) {
  const auto femur = test::knee_case().bones.at(BoneKind::Femur).mesh;
  const auto tunnel = test::knee_case().plan.tunnels.at(BoneKind::Femur);
  const auto drilled = drill(femur, tunnel);
  ASSERT_TRUE(drilled.is_usable()) << drilled.reason;
  EXPECT_TRUE(bones::mend_mesh(drilled.mesh).report.is_closed);
  const auto is_on_wall = [&](const Vector3d& p) {
    return std::abs((p - tunnel.entry_mm).cross(tunnel.direction).norm() - tunnel.diameter_mm / 2) < 0.01;
  };
  double longest_mm = 0;
  for (const auto& triangle : drilled.mesh.triangles) {
    std::array<Vector3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = drilled.mesh.vertices_mm[static_cast<std::size_t>(triangle[k])];
    if (!std::ranges::all_of(p, is_on_wall)) continue;
    for (std::size_t k = 0; k < 3; ++k) longest_mm = std::max(longest_mm, (p[k] - p[(k + 1) % 3]).norm());
  }
  EXPECT_GT(longest_mm, 1);
  EXPECT_LT(longest_mm, 3.1);
}

// Two holes of 8 mm, 5 mm apart: together they take away two circles less the lens that they share. As
// polygons of 96 sides of the circles' area they share it to a share of 1e-3.
TEST(DrilledBone, TakesTwoTunnelsOutAlsoWhereTheyRunIntoEachOther) {
  const auto slab = test::box({30, 30, 10});
  const auto at = [](double x_mm, norms::Bundle bundle) {
    return tunnels::Tunnel{BoneKind::Femur, {x_mm, -0.2, 10}, -Vector3d::UnitZ(), 8, bundle};
  };
  const auto removed = [&](double apart_mm) {
    const std::array both{at(0.3, norms::Bundle::Anteromedial),
                          at(0.3 + apart_mm, norms::Bundle::Posterolateral)};
    const auto drilled = drill(slab, both);
    EXPECT_TRUE(drilled.is_usable()) << drilled.reason;
    EXPECT_TRUE(bones::mend_mesh(drilled.mesh).report.is_closed);
    return geometry::signed_volume_mm3(slab) - geometry::signed_volume_mm3(drilled.mesh);
  };
  const double circle = geometry::kPi * 16;
  EXPECT_NEAR(removed(12), 2 * circle * 20, 0.02);
  const double lens = 2 * 16 * std::acos(5.0 / 8) - 2.5 * std::sqrt(4 * 16 - 25.0);
  EXPECT_NEAR(removed(5), (2 * circle - lens) * 20, 1e-3 * lens * 20);
  std::array missing{at(0.3, norms::Bundle::Anteromedial), at(300, norms::Bundle::Posterolateral)};
  EXPECT_EQ(drill(slab, missing).reason, "the tunnel femur PL misses the bone");
}

}  // namespace
}  // namespace arthronaut::plan_export
