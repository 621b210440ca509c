#include "navigation/simulator/sensor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "navigation/simulator/simulated_operation.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::simulator {
namespace {

// Even light comes out with the grey level of the gamma curve and the noise that was asked for.
TEST(Sensor, GivesTheLevelAndNoiseAskedFor) {
  const PixelArea area{10, 10, 200, 200};
  cv::Mat light(200, 200, CV_32FC3, cv::Scalar::all(0.4));
  camera::Frame frame;
  frame.width = frame.height = 220;
  Sensor({.read_noise_levels = 2.0, .shot_noise_share = 0.02}).expose(light, area, 3, frame);
  double sum = 0, squares = 0;
  long count = 0;
  for (int y = 30; y < 190; ++y) {
    for (int x = 30; x < 190; ++x) {
      for (int channel = 0; channel < 3; ++channel, ++count) {
        const double level = frame.bgr[static_cast<std::size_t>(3 * (y * 220 + x) + channel)];
        sum += level;
        squares += level * level;
      }
    }
  }
  const double mean = sum / static_cast<double>(count);
  const double variance = squares / static_cast<double>(count) - mean * mean;
  const double expected = 255 * std::pow(0.4, 1 / 2.2);
  EXPECT_NEAR(mean, expected, 0.1);  // the mean of 77 k values with a sigma of 2.6
  EXPECT_NEAR(variance, 4 + 0.02 * expected + 1.0 / 12, 0.15);
}

// The field stop is closed outside its circle and in its tooth, which stands at the mark's angle, and darkens
// to the rim.
TEST(FieldStop, IsACircleWithATooth) {
  const camera::Boundary boundary{{960, 540}, 520};
  for (const double angle_deg : {0.0, 93.0, 278.0}) {
    const FieldStop stop(boundary, angle_deg, 0.25);
    const auto at = [&](double radius, double at_deg) {
      const double a = geometry::rad_from_deg(at_deg);
      return stop.share_passed(960 + radius * std::cos(a), 540 + radius * std::sin(a));
    };
    EXPECT_EQ(at(0, 0), 1.0f);
    EXPECT_GT(at(515, angle_deg + 20), 0.7f);
    EXPECT_EQ(at(523, angle_deg + 20), 0.0f);
    EXPECT_EQ(at(512, angle_deg), 0.0f);
    EXPECT_GT(at(512, angle_deg + 4), 0.7f);
    EXPECT_GT(at(498, angle_deg), 0.7f);
  }
}

}  // namespace
}  // namespace arthronaut::simulator
