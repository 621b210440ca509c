#include "app/navigate/touch_check.h"

#include <gtest/gtest.h>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::navigate {
namespace {

// A block of bone whose upper face lies at z = 0; marker and bone frames coincide.
geometry::TriangleMesh block() { return test::box({20, 20, 15}, {0, 0, -15}); }

registration::RegistrationSummary fitted() {
  registration::RegistrationSummary registration;
  registration.has_pose = registration.reliable = true;
  return registration;
}

// A touch is where the tip stood: one jumping frame does not move it, and a moving tip is no touch.
TEST(SteadyTip, TakesTheMiddleOfARest) {
  SteadyTip tip;
  EXPECT_NE(tip.why_not(), "");
  for (int i = 0; i < 8; ++i) tip.add(i / 60.0, Eigen::Vector3d(1, i == 5 ? 2.6 : 2, 3));
  ASSERT_TRUE(tip.position_mm());
  EXPECT_NEAR((*tip.position_mm() - Eigen::Vector3d(1, 2, 3)).norm(), 0, 1e-12);
  EXPECT_EQ(tip.why_not(), "");
  for (int i = 8; i < 24; ++i) tip.add(i / 60.0, Eigen::Vector3d(1 + i, 2, 3));
  EXPECT_FALSE(tip.position_mm());
  EXPECT_NE(tip.why_not().find("still"), std::string::npos);
  for (int i = 24; i < 48; ++i) tip.add(i / 60.0, std::nullopt);
  EXPECT_FALSE(tip.position_mm());
  EXPECT_NE(tip.why_not().find("not known"), std::string::npos);
}

// Two touches off the bone raise the alarm, one does not; other distances by another registration take it
// back.
TEST(TouchCheck, TwoTouchesOffTheBoneRaiseTheAlarm) {
  const geometry::Surface surface(block());
  const auto registration = fitted();
  TouchCheck check;
  check.add_touch({0, 0, 0.4});
  check.add_touch({5, 0, 2.5});
  check.judge(&registration, &surface);
  EXPECT_NEAR(check.residuals_mm()[0].value(), 0.4, 1e-9);
  EXPECT_NEAR(*check.last().distance_mm, 2.5, 1e-9);
  EXPECT_EQ(check.alarm(), "");
  check.add_touch({0, 5, -1.8});
  check.judge(&registration, &surface);
  EXPECT_EQ(check.alarm(), "2 touches lie off the bone");
  auto shifted = registration;
  shifted.marker_from_bone.translation_mm = {0, 0, 2};
  check.judge(&shifted, &surface);
  EXPECT_EQ(check.alarm(), "2 touches lie off the bone") << "now the first and the third";
  check.judge(nullptr, &surface);
  EXPECT_EQ(check.alarm(), "");
  EXPECT_TRUE(check.residuals_mm().empty());
}

// On cartilage that the model lacks a touch should lie as far off the bone as its thickness; where that is
// not known, a touch says nothing and alarms nobody.
TEST(TouchCheck, TouchesOnCartilageAreJudgedByItsThickness) {
  const geometry::Surface surface(block());
  const registration::CartilageRegion covered{{{0, 0, 0}, {5, 0, 0}}, 4};
  auto registration = fitted();
  TouchCheck check;
  check.add_touch({0, 0, 2.1});
  check.add_touch({5, 0, 1.9});
  registration.cartilage_use = registration::CartilageUse::Solved;
  registration.cartilage_thickness_mm = 2;
  check.judge(&registration, &surface, covered);
  EXPECT_NEAR(check.residuals_mm()[0].value(), 0.1, 1e-9);
  EXPECT_NEAR(check.last().distance_mm.value(), -0.1, 1e-9);
  EXPECT_EQ(check.alarm(), "");
  registration.cartilage_use = registration::CartilageUse::LeftOut;
  check.judge(&registration, &surface, covered);
  EXPECT_FALSE(check.last().distance_mm.has_value());
  EXPECT_TRUE(check.last().is_on_unknown_cartilage);
  EXPECT_EQ(check.alarm(), "");
  registration.cartilage_use = registration::CartilageUse::None;
  check.judge(&registration, &surface, covered);
  EXPECT_EQ(check.alarm(), "2 touches lie off the bone");
}

// The control point is kept first and compared later; it raises the alarm at the second time it is off,
// whatever is registered, and one that is back where it was takes it away.
TEST(TouchCheck, AControlPointTellsABumpedMarker) {
  using Kind = TouchCheck::Last::Kind;
  TouchCheck check;
  check.touch_control_point({3, 4, 5});
  EXPECT_EQ(check.last().kind, Kind::ControlSet);
  check.touch_control_point({3, 4, 5.3});
  EXPECT_EQ(check.last().kind, Kind::ControlAgain);
  EXPECT_NEAR(*check.last().distance_mm, 0.3, 1e-9);
  check.touch_control_point({3, 4, 7.1});
  EXPECT_EQ(check.alarm(), "");
  check.touch_control_point({3, 4, 7.2});
  EXPECT_EQ(check.alarm(), "The control point has moved by 2.2 mm");
  check.touch_control_point({3, 4, 5.1});
  EXPECT_EQ(check.alarm(), "");
}

}  // namespace
}  // namespace arthronaut::navigate
