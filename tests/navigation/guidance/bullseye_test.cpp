#include "navigation/guidance/bullseye.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arthronaut::guidance {
namespace {

// Into the lateral wall of a knee's notch, patient's right being LPS -x.
tunnels::Tunnel plan_of(bones::Side side) {
  tunnels::Tunnel plan;
  plan.entry_mm = {3, 4, 5};
  plan.direction = Eigen::Vector3d::UnitX() * (side == bones::Side::Right ? -1 : 1);
  return plan;
}

// A guide whose axis misses the entry by `offset_mm` and leans by `lean`, its end 12 mm before the bone.
BullseyePoint point_of(const Eigen::Vector3d& offset_mm, const Eigen::Vector3d& lean, bones::Side side) {
  const tunnels::Tunnel plan = plan_of(side);
  const Eigen::Vector3d direction = (plan.direction + lean).normalized();
  return bullseye_point(plan.entry_mm + offset_mm - 12 * direction, direction,
                        landmarks::axes_across(landmarks::scanner_axes(side), plan.direction), plan);
}

// It looks along the plan with proximal up; anterior is on the side that it names; the dot is as far out as
// the axis misses the entry, and a lean alone does not move it.
TEST(Bullseye, PointIsWhereTheAxisMissesTheEntry) {
  for (const bones::Side side : {bones::Side::Right, bones::Side::Left}) {
    const BullseyePoint proximal = point_of({0, 0, 2}, {0, 0, 0}, side);
    EXPECT_EQ(proximal.up_is, landmarks::AnatomicalDirection::Proximal);
    EXPECT_NEAR(proximal.up_mm, 2, 1e-9);
    EXPECT_NEAR(proximal.right_mm, 0, 1e-9);
    const BullseyePoint leaning = point_of({0, 0, 0}, {0, 0, 0.1}, side);
    EXPECT_NEAR(leaning.lean_up_deg, geometry::deg_from_rad(std::atan(0.1)), 1e-9);
    EXPECT_NEAR(leaning.up_mm, 0, 1e-9);
  }
}

// Whoever looks into a right knee's lateral wall, proximal up, faces the patient's right: anterior, LPS -y,
// is to the left, since right is (-x) x z = +y. In a left knee it is to the right.
TEST(Bullseye, AnteriorIsLeftInARightKneeAndRightInALeftOne) {
  for (const bones::Side side : {bones::Side::Right, bones::Side::Left}) {
    const double to_the_right = side == bones::Side::Right ? -1 : 1;
    const BullseyePoint anterior = point_of({0, -1.5, 0}, {0, 0, 0}, side);
    EXPECT_EQ(anterior.side_is, landmarks::AnatomicalDirection::Anterior);
    EXPECT_EQ(anterior.side_is_right, side == bones::Side::Left);
    EXPECT_NEAR(anterior.right_mm, 1.5 * to_the_right, 1e-9);
    const BullseyePoint leaning = point_of({0, 0, 0}, {0, -0.1, 0}, side);
    EXPECT_NEAR(leaning.lean_right_deg, geometry::deg_from_rad(std::atan(0.1)) * to_the_right, 1e-9);
  }
}

}  // namespace
}  // namespace arthronaut::guidance
