// The tangent coordinates (X/Z, Y/Z) of every pixel of one camera and back, a hundred times faster than
// asking it pixel by pixel: the camera model is radial about its principal point, so a table over the squared
// radius holds all of it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "navigation/camera/camera_model.h"

namespace arthronaut::simulator {

class RayTable {
 public:
  // For pixels up to reach_px from the principal point. Error below 1e-7 (a ten-thousandth of a pixel).
  RayTable(const camera::CameraModel& camera, double reach_px);

  [[nodiscard]] Eigen::Vector2d tangent(double x_px, double y_px) const {
    const Eigen::Vector2d arm((x_px - center_.x()), (y_px - center_.y()) * inverse_aspect_);
    const double position = std::min(arm.squaredNorm() * entries_per_px2_, last_entry_);
    const auto entry = static_cast<std::size_t>(position);
    const double share = position - static_cast<double>(entry);
    return arm * (scale_[entry] + share * (scale_[entry + 1] - scale_[entry]));
  }

  // Of `count` pixels of a row, one beside the other.
  void row(double first_x_px, double y_px, int count, float* x, float* y) const {
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2d at = tangent(first_x_px + i, y_px);
      x[i] = static_cast<float>(at.x());
      y[i] = static_cast<float>(at.y());
    }
  }

  // The pixel that sees along (tangent, 1). Error below 0.001 px. What lies further out than the table
  // reaches comes out at its end, on the same side.
  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector2d& tangent) const {
    const double squared = tangent.squaredNorm();
    const double position = squared * entries_per_tangent2_;
    double scale = 0;
    if (position < pixel_scale_last_) {
      const auto entry = static_cast<std::size_t>(position);
      const double share = position - static_cast<double>(entry);
      scale = pixel_scale_[entry] + share * (pixel_scale_[entry + 1] - pixel_scale_[entry]);
    } else {
      scale = reach_px_ / std::sqrt(squared);
    }
    return center_ + Eigen::Vector2d(scale * tangent.x(), aspect_ * scale * tangent.y());
  }
  [[nodiscard]] double widest_tangent() const { return widest_tangent_; }

 private:
  Eigen::Vector2d center_;
  double inverse_aspect_ = 1, entries_per_px2_ = 1, last_entry_ = 0;
  std::vector<double> scale_;  // tangent / pixel arm
  double aspect_ = 1, reach_px_ = 0, widest_tangent_ = 0, entries_per_tangent2_ = 1, pixel_scale_last_ = 0;
  std::vector<double> pixel_scale_;  // pixel arm / tangent
};

}  // namespace arthronaut::simulator
