// From light to a frame: the round field stop with its tooth, the blur of the optics, the sensor's noise,
// gamma, 8 bits. Inner header of the simulator: OpenCV's picture may stand in it.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/simulator/bone_view.h"

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
  // The same for `width` pixels of a row from left_px on, taken from their light.
  void stop(double left_px, double y_px, int width, Eigen::Vector3f* light) const;

 private:
  [[nodiscard]] bool is_open(double dx, double dy) const;
  camera::Boundary boundary_;
  Eigen::Vector2d mark_;  // unit, towards the tooth
  double vignette_share_;
};

class Sensor {
 public:
  explicit Sensor(const SensorOptions& options);

  // `light` is the area's linear light (CV_32FC3) behind the field stop; it is used up. The noise is a
  // function of noise_seed and the pixel alone. At most kWidestPx pixels a row.
  void expose(cv::Mat& light, const PixelArea& area, std::uint64_t noise_seed, camera::Frame& frame) const;
  static constexpr int kWidestPx = 16384;

 private:
  struct Tone {
    float level = 0, noise_sigma = 0;  // grey levels
  };
  void expose_row(float* light, const PixelArea& area, std::size_t noise_from, int width,
                  std::uint8_t* out) const;

  double blur_sigma_px_;
  std::vector<Tone> tones_;         // by the square root of the light
  std::vector<std::uint8_t> dark_;  // what the sensor makes of no light, one value for each of the noise's
};

}  // namespace arthronaut::simulator
