// Pictures of a round view with a lens mark, drawn from their truth: circle, angle and polarity of the mark,
// light.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "navigation/camera/frame.h"

namespace arthronaut::lens {

struct RimTruth {
  int width = 960, height = 540;
  Eigen::Vector2d center_px{478.3, 269.8};
  double radius_px = 252.4;
  bool has_mark = true, is_bright_outward = false;
  double mark_angle_deg = 205.0;
  double half_width_deg = 2.1, height_share = 0.04;
  double noise = 1.5;  // grey values, 1 sigma
  unsigned seed = 7;
  // Grey value of the scene at an angle and a share of the radius; the default is tissue with some texture.
  std::function<double(double angle_deg, double radius_share)> scene = [](double angle_deg,
                                                                          double radius_share) {
    return 90 + 25 * std::sin(0.07 * angle_deg) + 15 * std::cos(0.11 * angle_deg + 9 * radius_share);
  };
};

inline double turn_between_deg(double a, double b) { return std::remainder(a - b, 360.0); }

struct RimPicture {
  RimTruth truth;
  std::vector<std::uint8_t> gray;
  [[nodiscard]] camera::GrayView view() const {
    return {gray.data(), truth.width, truth.height, truth.width};
  }
};

// The rim is a smooth step two pixels wide in light, shown with a gamma of 2.2, as a camera would.
inline RimPicture draw(const RimTruth& truth) {
  RimPicture picture{truth, {}};
  picture.gray.resize(static_cast<std::size_t>(truth.width) * truth.height);
  std::mt19937 random(truth.seed);
  std::normal_distribution<double> noise(0, truth.noise);
  for (int y = 0; y < truth.height; ++y)
    for (int x = 0; x < truth.width; ++x) {
      const Eigen::Vector2d d = Eigen::Vector2d(x, y) - truth.center_px;
      const double angle_deg = std::atan2(d.y(), d.x()) * 180 / M_PI, r = d.norm();
      double rim = truth.radius_px;
      if (truth.has_mark) {
        const double off = std::abs(turn_between_deg(angle_deg, truth.mark_angle_deg)) / truth.half_width_deg;
        rim += (truth.is_bright_outward ? 1 : -1) * truth.radius_px * truth.height_share *
               std::max(0.0, 1 - off);
      }
      const double open = std::clamp((rim - r) / 2 + 0.5, 0.0, 1.0);
      const double level = open > 0 ? truth.scene(angle_deg, r / truth.radius_px) : 0;
      const double light = 1e-6 + open * std::pow(std::max(0.0, level) / 255, 2.2);
      const double value = 255 * std::pow(light, 1 / 2.2) + 2 + noise(random);
      picture.gray[static_cast<std::size_t>(y) * truth.width + x] =
          static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
    }
  return picture;
}

}  // namespace arthronaut::lens
