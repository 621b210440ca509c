// From light to a frame: the round field stop with its tooth, the blur of the optics, the sensor's noise,
// gamma, 8 bits. Inner header of the simulator: OpenCV's picture may stand in it.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

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

 private:
  [[nodiscard]] bool is_open(double dx, double dy) const;
  camera::Boundary boundary_;
  Eigen::Vector2d mark_;  // unit, towards the tooth
  double vignette_share_;
};

// `light` is the area's linear light (CV_32FC3) behind the field stop; it is blurred in place. The noise is a
// function of noise_seed and the pixel alone.
void expose(cv::Mat& light, const PixelArea& area, const SensorOptions& options, std::uint64_t noise_seed,
            camera::Frame& frame);

}  // namespace arthronaut::simulator
