// The tangent coordinates (X/Z, Y/Z) of every pixel of one camera, a hundred times faster than asking it
// pixel by pixel: the camera model is radial about its principal point, so a table over the squared radius
// holds all of it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
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

 private:
  Eigen::Vector2d center_;
  double inverse_aspect_ = 1, entries_per_px2_ = 1, last_entry_ = 0;
  std::vector<double> scale_;  // tangent / pixel arm
};

}  // namespace arthronaut::simulator
