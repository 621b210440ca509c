#include "navigation/simulator/ray_table.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::simulator {
namespace {
constexpr int kEntries = 8192;
constexpr int kPixelEntries = 4096;
}  // namespace

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

  // Back by turning that table about: both are monotonic.
  aspect_ = camera.aspect_ratio();
  reach_px_ = reach_px;
  const auto radius_of = [&](std::size_t i) { return std::sqrt(static_cast<double>(i) / entries_per_px2_); };
  widest_tangent_ = radius_of(kEntries) * scale_[kEntries];
  entries_per_tangent2_ = kPixelEntries / (widest_tangent_ * widest_tangent_);
  pixel_scale_last_ = kPixelEntries - 1e-6;
  pixel_scale_.resize(kPixelEntries + 2, 1 / scale_[0]);
  std::size_t above = 1;
  for (std::size_t i = 1; i < pixel_scale_.size(); ++i) {
    const double tangent = std::sqrt(static_cast<double>(i) / entries_per_tangent2_);
    while (above + 1 < scale_.size() && radius_of(above) * scale_[above] < tangent) ++above;
    const double r0 = radius_of(above - 1), r1 = radius_of(above);
    const double t0 = r0 * scale_[above - 1], t1 = r1 * scale_[above];
    pixel_scale_[i] = (t1 > t0 ? r0 + (tangent - t0) / (t1 - t0) * (r1 - r0) : r1) / tangent;
  }
}

}  // namespace arthronaut::simulator
