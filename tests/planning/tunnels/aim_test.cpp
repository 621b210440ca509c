#include "planning/tunnels/aim.h"

#include <gtest/gtest.h>

#include "planning/geometry/rigid_transform.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::tunnels {
namespace {

using Eigen::Vector3d;

// A 40 mm slab: straight through is too long for 30 to 38 mm, and tilting only lengthens it, so that straight
// wins.
TEST(Aim, StaysStraightWhereTiltingIsWorse) {
  const geometry::Surface slab(test::box({200, 200, 20}));
  const Tunnel straight{.entry_mm = {0, 0, -20}, .direction = {0, 0, 1}};
  const auto aimed = aim(straight, slab, {.least_length_mm = 30, .greatest_length_mm = 38});
  EXPECT_LT((aimed.direction - Vector3d::UnitZ()).norm(), 1e-12);
}

// A slab of 40 mm asked for a tunnel of 41 mm and more needs acos(40 / 41) = 12.7 degrees: within reach
// of 14.
TEST(Aim, TiltsToFitTheLength) {
  const geometry::Surface slab(test::box({200, 200, 20}));
  const Tunnel straight{.entry_mm = {0, 0, -20}, .direction = {0, 0, 1}};
  const auto aimed = aim(straight, slab, {.least_length_mm = 41, .greatest_length_mm = 50});
  EXPECT_GE(measure(aimed, slab).length_mm, 41);
  EXPECT_LE(geometry::deg_from_rad(geometry::angle_between_rad(aimed.direction, straight.direction)),
            14 + 1e-9);
  EXPECT_EQ(aimed.entry_mm, straight.entry_mm);
}

// Where bone narrows with depth the tunnel leans away from the narrowing side, towards more bone.
TEST(Aim, LeansAwayFromAThinWall) {
  const geometry::Surface wedge(test::prism({{30, -20}, {22, 20}, {-60, 20}, {-60, -20}}, 200, {-20, 0}));
  const Tunnel near_side{.entry_mm = {0, 16.5, -20}, .direction = {0, 0, 1}};
  const auto aimed = aim(near_side, wedge, {.least_length_mm = 36, .greatest_length_mm = 45});
  EXPECT_LT(aimed.direction.y(), -0.05);
  EXPECT_GT(measure(aimed, wedge).wall_mm, measure(near_side, wedge).wall_mm + 1);
}

// The custom is mirrored with the knee, and unit.
TEST(Aim, MirrorsTheCustomaryDirection) {
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    const Vector3d right = customary_direction(kind, bones::Side::Right),
                   left = customary_direction(kind, bones::Side::Left);
    EXPECT_EQ(Vector3d(-left.x(), left.y(), left.z()), right);
    EXPECT_NEAR(right.norm(), 1, 1e-12);
  }
  EXPECT_LT(customary_direction(bones::BoneKind::Femur, bones::Side::Right).x(), 0);  // lateral
  EXPECT_GT(customary_direction(bones::BoneKind::Tibia, bones::Side::Right).x(), 0);  // medial
}

}  // namespace
}  // namespace arthronaut::tunnels
