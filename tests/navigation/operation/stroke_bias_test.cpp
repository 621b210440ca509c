// How a registration follows probe and camera: by the strokes that are there, and no others.
#include "navigation/operation/stroke_bias.h"

#include <gtest/gtest.h>

namespace arthronaut::operation {
namespace {

// A point of a stroke, and how it moves with the probe's error: as the probe was turned.
void draw_turned(StrokeBook& strokes, StrokeBias& bias, double from_s, double turn_rad) {
  for (int i = 0; i < 50; ++i) {
    const double time_s = from_s + 0.02 * i;
    const Eigen::Vector3d tip_mm(10 * time_s, 2 * std::sin(3 * time_s), 2 * std::cos(2 * time_s));
    const int curve = strokes.add(time_s, tip_mm).curve;
    guidance::TipSensitivity sensitivity;
    sensitivity.tip_mm = tip_mm;
    sensitivity.per_tip_error = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    bias.add(curve, sensitivity, i > 0 ? 0.2 : 0);
  }
}

TEST(StrokeBias, IsOfTheStrokesThatAreUsed) {
  StrokeBook strokes, second_alone;
  StrokeBias bias, bias_of_second;
  const auto found_now = [](StrokeBias& by, const StrokeBook& drawn, std::size_t number) {
    by.on_registrations(number + 1, drawn);
    return by.of_registration(number);
  };
  EXPECT_FALSE(found_now(bias, strokes, 0));
  draw_turned(strokes, bias, 0, 0);
  draw_turned(strokes, bias, 10, 1.5);
  draw_turned(second_alone, bias_of_second, 10, 1.5);
  const auto of_second = found_now(bias_of_second, second_alone, 0);
  ASSERT_TRUE(of_second);
  EXPECT_FALSE(found_now(bias, strokes, 1)->per_tip_error.isApprox(of_second->per_tip_error, 1e-3));
  strokes.exclude(strokes.points().front().curve, true);
  EXPECT_TRUE(found_now(bias, strokes, 2)->per_tip_error.isApprox(of_second->per_tip_error, 1e-12));
  (void)strokes.take_back();
  EXPECT_FALSE(found_now(bias, strokes, 3)) << "the one is excluded, the other was taken back";
}

// One that is taken again, or confirmed, after other strokes were drawn: it was found by those of its own.
TEST(StrokeBias, ARegistrationKeepsThatOfTheStrokesItWasFoundBy) {
  StrokeBook strokes;
  StrokeBias bias;
  draw_turned(strokes, bias, 0, 0);
  bias.on_registrations(1, strokes);
  ASSERT_TRUE(bias.of_registration(0));
  const guidance::RegistrationBias first = *bias.of_registration(0);
  strokes.clear();
  bias.on_strokes_cleared();
  bias.on_registrations(1, strokes);
  EXPECT_EQ(bias.of_registration(0)->per_tip_error, first.per_tip_error);
  draw_turned(strokes, bias, 10, 1.5);
  bias.on_registrations(2, strokes);
  EXPECT_EQ(bias.of_registration(0)->per_tip_error, first.per_tip_error);
  EXPECT_NE(bias.of_registration(1)->per_tip_error, first.per_tip_error);
}

// Another camera or probe has errors of its own.
TEST(StrokeBias, WithAnotherSourceNoneIsLeft) {
  StrokeBook strokes;
  StrokeBias bias;
  draw_turned(strokes, bias, 0, 0);
  bias.on_registrations(1, strokes);
  bias.on_other_source();
  EXPECT_FALSE(bias.of_registration(0));
}

}  // namespace
}  // namespace arthronaut::operation
