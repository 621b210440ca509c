#include "planning/graft/graft_course.h"

#include <gtest/gtest.h>

#include <cmath>

#include "planning/geometry/error.h"

namespace arthronaut::graft {
namespace {

using Eigen::Vector3d;

const FlexionAxis kAxis{FlexionAxis::Origin::CondyleCenters, {0, 2, 3}, Vector3d::UnitX()};

// From the axis the tibia keeps its distance; from anywhere else it changes by the law of cosines.
TEST(GraftCourse, FollowsTheHinge) {
  const GraftEnd tibia{{4, 2, 3 - 30}, -Vector3d::UnitZ()};
  const auto still = graft_course({{-8, 2, 3}, Vector3d::UnitX()}, tibia, kAxis);
  EXPECT_NEAR(still.change_mm(), 0, 1e-9);
  EXPECT_NEAR(still.states.front().length_mm, std::hypot(12, 30), 1e-9);

  // 6 mm in front of the axis: the tibia's point is on the circle of 30 mm, straight below at first, then
  // backwards.
  const auto course =
      graft_course({{4, 2 - 6, 3}, Vector3d::UnitX()}, tibia, kAxis, {.to_deg = 120, .step_deg = 10});
  ASSERT_EQ(course.states.size(), 13U);
  for (const GraftState& state : course.states) {
    const double angle = geometry::rad_from_deg(90 + state.flexion_deg);
    EXPECT_NEAR(state.length_mm, std::sqrt(6 * 6 + 30 * 30 - 2 * 6 * 30 * std::cos(angle)), 1e-9);
  }
  EXPECT_NEAR(course.longest_mm, 36, 1e-9);
  EXPECT_NEAR(course.longest_at_deg, 90, 1e-9);
}

// A graft that goes on straight does not bend; one that leaves square to the tunnel bends by 90 deg. At 90
// deg of flexion the tibial tunnel, which was straight, is bent by as much as the graft has turned against
// the tibia.
TEST(GraftCourse, MeasuresBends) {
  const GraftEnd femur{{0, 2, 3}, Vector3d::UnitZ()}, tibia{{0, 2, -27}, -Vector3d::UnitZ()};
  const auto course = graft_course(femur, tibia, kAxis, {.to_deg = 90, .step_deg = 45});
  EXPECT_NEAR(course.states[0].femoral_bend_deg, 0, 1e-9);
  EXPECT_NEAR(course.states[0].tibial_bend_deg, 0, 1e-9);
  EXPECT_NEAR(course.states[2].femoral_bend_deg, 90, 1e-9);
  EXPECT_NEAR(course.states[2].tibial_bend_deg, 0,
              1e-9);  // the femoral end is on the axis: tibia and graft turn as one
  EXPECT_NEAR(course.greatest_femoral_bend_deg, 90, 1e-9);
  const auto sideways = graft_course({{0, 2, 3}, Vector3d::UnitX()}, tibia, kAxis);
  for (const auto& state : sideways.states) EXPECT_NEAR(state.femoral_bend_deg, 90, 1e-9);
}

TEST(GraftCourse, RefusesARangeThatIsNone) {
  EXPECT_THROW((void)graft_course({}, {}, kAxis, {.to_deg = -1}), InvalidInput);
  EXPECT_THROW((void)graft_course({}, {}, kAxis, {.step_deg = std::nan("")}), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::graft
