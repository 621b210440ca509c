#include "navigation/operation/touches.h"

#include <gtest/gtest.h>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::operation {
namespace {

using Reason = SteadyTip::Reason;
using AlarmKind = TouchAlarm::Kind;

// A block of bone whose upper face lies at z = 0; marker and bone frames coincide.
geometry::TriangleMesh block() { return test::box({20, 20, 15}, {0, 0, -15}); }

registration::RegistrationSummary fitted() {
  registration::RegistrationSummary registration;
  registration.has_pose = registration.reliable = true;
  return registration;
}

const registration::Provenance kHere;

// A touch is where the tip stood: one jumping frame does not move it, and a moving tip is no touch.
TEST(SteadyTip, TakesTheMiddleOfARest) {
  SteadyTip tip;
  EXPECT_EQ(tip.why_not(), Reason::TipUnknown);
  for (int i = -4; i < 8; ++i) tip.add(i / 60.0, Eigen::Vector3d(1, i == 5 ? 2.6 : 2, 3));
  ASSERT_TRUE(tip.position_mm());
  EXPECT_NEAR((*tip.position_mm() - Eigen::Vector3d(1, 2, 3)).norm(), 0, 1e-12);
  EXPECT_EQ(tip.why_not(), Reason::None);
  for (int i = 8; i < 24; ++i) tip.add(i / 60.0, Eigen::Vector3d(1 + i, 2, 3));
  EXPECT_FALSE(tip.position_mm());
  EXPECT_EQ(tip.why_not(), Reason::Moves);
  for (int i = 24; i < 48; ++i) tip.add(i / 60.0, std::nullopt);
  EXPECT_FALSE(tip.position_mm());
  EXPECT_EQ(tip.why_not(), Reason::TipUnknown);
}

// At 25 mm a second a tip is within 0.4 mm of its middle in the three pictures of 33 ms: that is no rest, at
// any number of pictures a second, and neither is what was seen of it before it was out of sight.
TEST(SteadyTip, ATipThatIsSeenForAMomentDoesNotRest) {
  for (const double per_second : {120.0, 60.0, 50.0, 30.0}) {
    SCOPED_TRACE(per_second);
    SteadyTip tip;
    int i = 0;
    const auto seen_for = [&](double seconds, double mm_per_s) {
      for (const int end = i + static_cast<int>(seconds * per_second); i <= end; ++i)
        tip.add(i / per_second, Eigen::Vector3d(mm_per_s * i / per_second, 2, 3));
    };
    seen_for(0.07, 25);
    EXPECT_FALSE(tip.position_mm());
    EXPECT_EQ(tip.why_not(), Reason::TipUnknown) << "not for long enough";
    seen_for(0.2, 25);
    EXPECT_FALSE(tip.position_mm());
    EXPECT_EQ(tip.why_not(), Reason::Moves);
    seen_for(0.3, 0);
    EXPECT_TRUE(tip.position_mm());
    for (const int end = i + static_cast<int>(0.2 * per_second); i <= end; ++i)
      tip.add(i / per_second, std::nullopt);
    EXPECT_FALSE(tip.position_mm()) << "a few pictures of before are left";
  }
}

// Two touches off the bone raise the alarm, one does not; other distances by another registration take it
// back.
TEST(Touches, TwoTouchesOffTheBoneRaiseTheAlarm) {
  const geometry::Surface surface(block());
  const auto registration = fitted();
  Touches touches;
  touches.add_touch({0, 0, 0.4}, kHere);
  touches.add_touch({5, 0, 2.5}, kHere);
  touches.judge(&registration, &surface, std::nullopt, kHere);
  EXPECT_NEAR(touches.residuals_mm()[0].value(), 0.4, 1e-9);
  EXPECT_NEAR(touches.last().distance_mm.value(), 2.5, 1e-9);
  EXPECT_FALSE(touches.alarm());
  touches.add_touch({0, 5, -1.8}, kHere);
  touches.judge(&registration, &surface, std::nullopt, kHere);
  EXPECT_EQ(touches.alarm().kind, AlarmKind::TouchesOff);
  EXPECT_EQ(in_words(touches.alarm()), "2 touches lie off the bone");
  auto shifted = registration;
  shifted.marker_from_bone.translation_mm = {0, 0, 2};
  touches.judge(&shifted, &surface, std::nullopt, kHere);
  EXPECT_EQ(touches.alarm().touches_off, 2) << "now the first and the third";
  touches.judge(nullptr, &surface, std::nullopt, kHere);
  EXPECT_FALSE(touches.alarm());
  EXPECT_TRUE(touches.residuals_mm().empty());
}

// A touch says nothing about a registration of something else: neither an alarm nor a verification.
TEST(Touches, TouchesOfAnotherProvenanceSayNothing) {
  const geometry::Surface surface(block());
  const auto registration = fitted();
  registration::Provenance elsewhere;
  elsewhere.refractive_index = 1.3345;
  Touches touches;
  for (const double x_mm : {-8.0, 0.0, 8.0}) touches.add_touch({x_mm, 0, 0.1}, elsewhere);
  touches.judge(&registration, &surface, std::nullopt, kHere);
  EXPECT_FALSE(touches.verify());
  EXPECT_FALSE(touches.last_confirms());
  for (const auto& residual_mm : touches.residuals_mm()) EXPECT_FALSE(residual_mm);
  touches.judge(&registration, &surface, std::nullopt, elsewhere);
  EXPECT_TRUE(touches.verify());
  EXPECT_TRUE(touches.last_confirms());
  for (const double x_mm : {-8.0, 8.0}) touches.add_touch({x_mm, 8, 3}, elsewhere);
  touches.judge(&registration, &surface, std::nullopt, kHere);
  EXPECT_FALSE(touches.alarm());
  touches.judge(&registration, &surface, std::nullopt, elsewhere);
  EXPECT_EQ(touches.alarm().kind, AlarmKind::TouchesOff);
}

// Three places verify, all near and in the median nearer; one place three times is one place.
TEST(Touches, ThreePlacesVerify) {
  const geometry::Surface surface(block());
  const auto registration = fitted();
  const auto verified = [&](const std::vector<Eigen::Vector3d>& places_mm) {
    Touches touches;
    for (const Eigen::Vector3d& place_mm : places_mm) touches.add_touch(place_mm, kHere);
    touches.judge(&registration, &surface, std::nullopt, kHere);
    return touches.verify();
  };
  EXPECT_TRUE(verified({{0, 0, 0.2}, {6, 0, 0.5}, {-6, 0, 0.9}}));
  EXPECT_FALSE(verified({{0, 0, 0.2}, {6, 0, 0.5}}));
  EXPECT_FALSE(verified({{0, 0, 0.2}, {0.5, 0, 0.2}, {0, 0.5, 0.2}})) << "one place";
  EXPECT_FALSE(verified({{0, 0, 0.2}, {6, 0, 0.5}, {-6, 0, 1.1}})) << "one is off";
  EXPECT_FALSE(verified({{0, 0, 0.7}, {6, 0, 0.7}, {-6, 0, 0.2}})) << "not near enough in the median";
}

// What is still missing are places, not touches; one that is off counts too, and verifies nothing.
TEST(Touches, CountsThePlacesThatAreMissing) {
  const geometry::Surface surface(block());
  const auto registration = fitted();
  Touches touches;
  const auto missing_after = [&](const Eigen::Vector3d& place_mm) {
    touches.add_touch(place_mm, kHere);
    touches.judge(&registration, &surface, std::nullopt, kHere);
    return touches.places_to_verify();
  };
  EXPECT_EQ(touches.places_to_verify(), 3);
  EXPECT_EQ(missing_after({0, 0, 0.2}), 2);
  EXPECT_EQ(missing_after({0.5, 0, 0.2}), 2);
  EXPECT_EQ(missing_after({6, 0, 1.4}), 1);
  EXPECT_EQ(missing_after({-6, 0, 0.2}), 0);
  EXPECT_EQ(missing_after({0, 8, 0.2}), 0);
  EXPECT_FALSE(touches.verify());
  touches.judge(nullptr, &surface, std::nullopt, kHere);
  EXPECT_EQ(touches.places_to_verify(), 3) << "none is judged without a registration";
}

// On cartilage that the model lacks a touch should lie as far off the bone as its thickness; where that is
// not known, a touch says nothing and alarms nobody.
TEST(Touches, TouchesOnCartilageAreJudgedByItsThickness) {
  const geometry::Surface surface(block());
  const registration::CartilageRegion covered{{{0, 0, 0}, {5, 0, 0}}, 4};
  auto registration = fitted();
  Touches touches;
  touches.add_touch({0, 0, 2.1}, kHere);
  touches.add_touch({5, 0, 1.9}, kHere);
  registration.cartilage_use = registration::CartilageUse::Solved;
  registration.cartilage_thickness_mm = 2;
  touches.judge(&registration, &surface, covered, kHere);
  EXPECT_NEAR(touches.residuals_mm()[0].value(), 0.1, 1e-9);
  EXPECT_NEAR(touches.last().distance_mm.value(), -0.1, 1e-9);
  EXPECT_FALSE(touches.alarm());
  registration.cartilage_use = registration::CartilageUse::LeftOut;
  touches.judge(&registration, &surface, covered, kHere);
  EXPECT_FALSE(touches.last().distance_mm.has_value());
  EXPECT_TRUE(touches.last().is_on_unknown_cartilage);
  EXPECT_FALSE(touches.alarm());
  registration.cartilage_use = registration::CartilageUse::None;
  touches.judge(&registration, &surface, covered, kHere);
  EXPECT_EQ(touches.alarm().touches_off, 2);
}

// The control point is kept first and compared later; it raises the alarm at the second time it is off,
// whatever is registered, and one that is back where it was takes it away.
TEST(Touches, AControlPointTellsABumpedMarker) {
  using Kind = Touches::Last::Kind;
  Touches touches;
  touches.touch_control_point({3, 4, 5}, kHere);
  EXPECT_EQ(touches.last().kind, Kind::ControlSet);
  touches.touch_control_point({3, 4, 5.3}, kHere);
  EXPECT_EQ(touches.last().kind, Kind::ControlAgain);
  EXPECT_NEAR(touches.last().distance_mm.value(), 0.3, 1e-9);
  touches.touch_control_point({3, 4, 7.1}, kHere);
  EXPECT_FALSE(touches.alarm());
  touches.touch_control_point({3, 4, 7.2}, kHere);
  EXPECT_EQ(in_words(touches.alarm()), "The control point has moved by 2.2 mm");
  touches.touch_control_point({3, 4, 5.1}, kHere);
  EXPECT_FALSE(touches.alarm());
  // That it is where it was is said of what the pictures are of now, and of nothing else.
  registration::Provenance elsewhere = kHere;
  ++elsewhere.placement;
  touches.judge(nullptr, nullptr, std::nullopt, elsewhere);
  EXPECT_EQ(touches.last().kind, Kind::None);
  EXPECT_TRUE(touches.has_control_point());
}

}  // namespace
}  // namespace arthronaut::operation
