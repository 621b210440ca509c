#include "navigation/simulator/sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "navigation/simulator/simulated_operation.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::simulator {
namespace {

// Even light comes out with the grey level of the gamma curve and the noise that was asked for.
TEST(Sensor, GivesTheLevelAndNoiseAskedFor) {
  const PixelArea area{10, 10, 200, 200};
  const std::vector<float> light(Sensor::light_size(area), 0.4f);
  camera::Frame frame;
  frame.width = frame.height = 220;
  Sensor({.read_noise_levels = 2.0, .shot_noise_share = 0.02}).expose(light, area, nullptr, 3, frame);
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

// Every grey level is that of the gamma curve, and black is black.
TEST(Sensor, FollowsTheGammaCurve) {
  const PixelArea area{0, 0, 64, 64};
  camera::Frame frame;
  frame.width = frame.height = 64;
  for (const double light : {0.0, 1e-6, 1e-4, 0.003, 0.02, 0.1, 0.3, 0.7, 0.999, 1.0, 3.0}) {
    const std::vector<float> even(Sensor::light_size(area), static_cast<float>(light));
    Sensor({.read_noise_levels = 0, .shot_noise_share = 0}).expose(even, area, nullptr, 3, frame);
    const double level = 255 * std::pow(std::min(light, 1.0), 1 / 2.2);
    EXPECT_NEAR(frame.bgr[3 * (32 * 64 + 32)], level, 0.51) << light;
  }
}

// A bright column is blurred as a normal distribution is, along rows and across them alike.
TEST(Sensor, BlursAlikeBothWays) {
  const PixelArea area{0, 0, 40, 40};
  camera::Frame frame;
  frame.width = frame.height = 40;
  const auto profile = [&](bool is_column) {
    std::vector<float> light(Sensor::light_size(area), 0.0f);
    for (std::size_t i = 0; i < 40; ++i)
      for (std::size_t c = 0; c < 3; ++c) light[3 * (is_column ? 40 * i + 20 : 800 + i) + c] = 1;
    Sensor({.blur_sigma_px = 1.0, .read_noise_levels = 0, .shot_noise_share = 0})
        .expose(light, area, nullptr, 1, frame);
    std::vector<int> levels;
    for (std::size_t i = 14; i < 27; ++i)
      levels.push_back(frame.bgr[3 * (is_column ? 40 * 20 + i : 40 * i + 20)]);
    return levels;
  };
  const std::vector<int> along = profile(true), across = profile(false);
  EXPECT_EQ(along, across);
  for (std::size_t i = 0; i < along.size(); ++i) {
    const double away = static_cast<double>(i) - 6;
    const double light = std::abs(away) > 3 ? 0 : 0.39905 * std::exp(-0.5 * away * away);
    EXPECT_NEAR(along[i], 255 * std::pow(light, 1 / 2.2), 0.51) << away;
  }
}

// What the field stop shuts out is not computed, and would be black: with a stop as without.
TEST(Sensor, LeavesOutWhatIsDark) {
  const PixelArea area{7, 5, 80, 90};
  const FieldStop stop({{46, 49}, 38}, 30, 0.25);
  std::vector<float> light(Sensor::light_size(area), 0.7f);
  for (int row = 0; row < area.height; ++row)
    stop.stop(area.left, area.top + row, area.width, light.data() + 3 * area.width * row);
  camera::Frame all, open;
  all.width = all.height = open.width = open.height = 100;
  Sensor sensor({});
  sensor.expose(light, area, nullptr, 4, all);
  sensor.expose(light, area, &stop, 4, open);
  EXPECT_EQ(all.bgr, open.bgr);
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
