// From light to a frame: the round field stop with its tooth, the blur of the optics, the sensor's noise,
// gamma, 8 bits.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/simulator/bone_view.h"
#include "navigation/simulator/parallel_rows.h"
#include "navigation/simulator/picture_kernel.h"

namespace arthronaut::simulator {

struct SensorOptions {
  double blur_sigma_px = 1.0;
  double read_noise_levels = 2.0;  // grey levels
  double shot_noise_share = 0.02;  // variance in grey levels squared for each grey level
  double vignette_share = 0.25;    // of the light lost at the rim
};

// Share of the light that passes the field stop at a pixel, vignette included. The tooth is dark and points
// inwards.
class FieldStop {
 public:
  FieldStop(const camera::Boundary& boundary, double mark_angle_deg, double vignette_share);
  [[nodiscard]] float share_passed(double x_px, double y_px) const;
  // The same for `width` pixels of a row from left_px on, taken from their light, three values a pixel.
  void stop(double left_px, double y_px, int width, float* light) const;
  // Of such a row the pixels, from the first to one behind the last, beyond which nothing passes.
  [[nodiscard]] std::array<int, 2> open_columns(double left_px, double y_px, int width) const;

 private:
  [[nodiscard]] bool is_open(double dx, double dy) const;
  camera::Boundary boundary_;
  Eigen::Vector2d mark_;  // unit, towards the tooth
  double vignette_share_;
};

class Sensor {
 public:
  explicit Sensor(const SensorOptions& options);

  // How many values expose() wants to find: three a pixel, and some to spare.
  [[nodiscard]] static std::size_t light_size(const PixelArea& area) {
    return static_cast<std::size_t>(3) * static_cast<std::size_t>(area.width) *
               static_cast<std::size_t>(area.height) +
           kTogether;
  }
  // `light` is the area's linear light, blue green red, row after row, which passed the field stop, if there
  // is one. The noise is a function of noise_seed and the pixel alone. At most kWidestPx pixels a row.
  void expose(const std::vector<float>& light, const PixelArea& area, const FieldStop* stop,
              std::uint64_t noise_seed, camera::Frame& frame);
  static constexpr int kWidestPx = 16384;

 private:
  // Of one thread.
  struct Memory {
    std::vector<float> across, along;
    std::vector<std::uint8_t> grey;
  };
  void expose_row(const float* light, const PixelArea& area, int row, const std::array<int, 2>& columns,
                  const float* deviates, Memory& memory, std::uint8_t* out) const;

  float blur_[kBlurReach + 1] = {1};  // weights of the middle and of its neighbours
  ToneNumbers tone_;
  std::vector<std::uint8_t> dark_;  // what the sensor makes of no light, one value for each of the noise's
  std::array<Memory, kMostThreads> memory_;
};

}  // namespace arthronaut::simulator
