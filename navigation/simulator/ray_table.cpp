#include "navigation/simulator/ray_table.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::simulator {
namespace {
constexpr int kEntries = 8192;
}

RayTable::RayTable(const camera::CameraModel& camera, double reach_px)
    : center_(camera.principal_point_px()),
      inverse_aspect_(1 / camera.aspect_ratio()),
      entries_per_px2_(kEntries / (reach_px * reach_px)),
      last_entry_(kEntries - 1e-6),
      scale_(kEntries + 2) {
  for (std::size_t i = 0; i < scale_.size(); ++i) {
    // The first entry's radius is not 0, where the quotient has no value.
    const double radius = std::sqrt((i == 0 ? 1e-4 : static_cast<double>(i)) / entries_per_px2_);
    const auto tangent = camera.undistort(center_ + Eigen::Vector2d(radius, 0));
    // Beyond the critical angle nothing is seen; the field stop hides it.
    scale_[i] = tangent ? tangent->x() / radius : scale_[i - 1];
  }
}

}  // namespace arthronaut::simulator
