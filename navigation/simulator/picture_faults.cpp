#include "navigation/simulator/picture_faults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "navigation/simulator/random.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::simulator {

namespace {

struct Cloud {
  double x, y, radius, thickness;  // px, at the moment
};

constexpr int kClouds = 6;

std::array<Cloud, kClouds> clouds_at(const camera::Frame& frame, std::uint64_t seed, double time_s) {
  Random random(seed * 77 + 5);
  std::array<Cloud, kClouds> clouds{};
  const double size = frame.height;
  for (Cloud& cloud : clouds) {
    const double phase = random.between(0, 2 * geometry::kPi), period = random.between(5, 11);
    const double turn = 2 * geometry::kPi * time_s / period + phase;
    cloud.x = frame.width / 2.0 + size * (random.between(-0.3, 0.3) + 0.2 * std::cos(turn));
    cloud.y = frame.height / 2.0 + size * (random.between(-0.3, 0.3) + 0.2 * std::sin(0.7 * turn));
    cloud.radius = size * random.between(0.12, 0.24);
    cloud.thickness = 0.55 + 0.45 * std::sin(1.3 * turn);  // it comes and goes
  }
  return clouds;
}

std::uint8_t mixed(std::uint8_t value, double other, double share) {
  return static_cast<std::uint8_t>(std::clamp((1 - share) * value + share * other, 0.0, 255.0));
}

// Outside the field stop, or as dark.
bool is_behind_stop(const std::uint8_t* pixel) { return pixel[0] + pixel[1] + pixel[2] < 24; }

// What spoils the picture takes its colours alone: luma is computed from them anew.
void colours_changed(camera::Frame& frame) { frame.luma.clear(); }

}  // namespace

void add_bleeding(camera::Frame& frame, std::uint64_t seed, double time_s, double strength) {
  const double most = std::clamp(strength, 0.0, 1.0);
  if (!(most > 0)) return;
  constexpr std::array<double, 3> kBlood{12, 10, 120};  // BGR
  const auto clouds = clouds_at(frame, seed, time_s);
  constexpr int kCell = 8;  // a cloud has no edge: it is computed on cells
  for (int y0 = 0; y0 < frame.height; y0 += kCell)
    for (int x0 = 0; x0 < frame.width; x0 += kCell) {
      double clear = 1;
      for (const Cloud& cloud : clouds) {
        const double dx = (x0 - cloud.x) / cloud.radius, dy = (y0 - cloud.y) / cloud.radius;
        clear *= 1 - most * cloud.thickness * std::exp(-(dx * dx + dy * dy));
      }
      const double share = 1 - clear;
      if (share < 0.004) continue;
      for (int y = y0; y < std::min(y0 + kCell, frame.height); ++y)
        for (int x = x0; x < std::min(x0 + kCell, frame.width); ++x) {
          std::uint8_t* const pixel =
              frame.bgr.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) +
                                      static_cast<std::size_t>(x));
          if (is_behind_stop(pixel)) continue;  // nothing shines there, blood neither
          for (std::size_t c = 0; c < 3; ++c) pixel[c] = mixed(pixel[c], kBlood[c], share);
        }
    }
  colours_changed(frame);
}

void add_glare(camera::Frame& frame, std::uint64_t seed, double time_s, double strength) {
  const double most = std::clamp(strength, 0.0, 1.0);
  if (!(most > 0)) return;
  Random random(seed * 131 + 9);
  const double phase = random.between(0, 2 * geometry::kPi), turn = 0.9 * time_s + phase;
  const double x = frame.width / 2.0 + 0.25 * frame.height * std::cos(turn);
  const double y = frame.height / 2.0 + 0.22 * frame.height * std::sin(1.3 * turn);
  const double radius = most * frame.height / 3.0;
  for (int row = std::max(0, static_cast<int>(y - radius));
       row < std::min(frame.height, static_cast<int>(y + radius) + 1); ++row)
    for (int column = std::max(0, static_cast<int>(x - radius));
         column < std::min(frame.width, static_cast<int>(x + radius) + 1); ++column) {
      const double away = std::hypot(column - x, row - y) / radius;
      if (away >= 1) continue;
      const double share = std::min(1.0, 1.6 * (1 - away));
      std::uint8_t* const pixel =
          frame.bgr.data() + 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.width) +
                                  static_cast<std::size_t>(column));
      for (std::size_t c = 0; c < 3; ++c) pixel[c] = mixed(pixel[c], 255, share);
    }
  colours_changed(frame);
}

void add_fog(camera::Frame& frame, double strength) {
  const double sigma_px = 0.012 * frame.height * std::clamp(strength, 0.0, 1.0);
  if (!(sigma_px > 0.1)) return;
  cv::Mat picture(frame.height, frame.width, CV_8UC3, frame.bgr.data()), fogged;
  cv::GaussianBlur(picture, fogged, {}, sigma_px);
  for (int y = 0; y < frame.height; ++y) {
    auto* const out = picture.ptr<std::uint8_t>(y);
    const auto* const in = fogged.ptr<std::uint8_t>(y);
    for (int x = 0; x < 3 * frame.width; x += 3)
      if (!is_behind_stop(out + x)) std::copy_n(in + x, 3, out + x);
  }
  colours_changed(frame);
}

void black_out(camera::Frame& frame, std::uint64_t seed) {
  Random random(seed);
  for (std::uint8_t& value : frame.bgr) value = static_cast<std::uint8_t>(random.bits() % 5);
  colours_changed(frame);
}

}  // namespace arthronaut::simulator
