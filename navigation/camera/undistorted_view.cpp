#include "navigation/camera/undistorted_view.h"

#include <algorithm>
#include <cmath>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::camera {

UndistortedView::UndistortedView(const CameraModel& camera)
    : camera_(camera), half_extent_(half_extent_of(camera)) {
  table_px_.reserve(2 * static_cast<std::size_t>(kNodes) * kNodes);
  for (int row = 0; row < kNodes; ++row) {
    for (int column = 0; column < kNodes; ++column) {
      const Eigen::Vector2d view(2.0 * column / (kNodes - 1) - 1, 2.0 * row / (kNodes - 1) - 1);
      // Beyond the critical angle the last ray goes on outwards, so that nothing folds back into the view.
      double shrink = 1;
      auto pixel = camera.project((half_extent_ * view).homogeneous());
      while (!pixel) {
        shrink *= 0.98;
        pixel = camera.project((shrink * half_extent_ * view).homogeneous());
      }
      const Eigen::Vector2d arm = (*pixel - camera.principal_point_px()) / shrink;
      table_px_.push_back(static_cast<float>(arm.x()));
      table_px_.push_back(static_cast<float>(arm.y()));
    }
  }
}

double UndistortedView::half_extent_of(const CameraModel& camera) {
  constexpr int kDirections = 256;
  const Eigen::Vector2d size = camera.image_size_px().cast<double>();
  const Boundary& boundary = camera.boundary();
  double extent = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * geometry::kPi * i / kDirections;
    const Eigen::Vector2d out(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d pixel = boundary.radius_px > 0
                                      ? Eigen::Vector2d(boundary.center_px + boundary.radius_px * out)
                                      : Eigen::Vector2d(size / 2 + size.cwiseProduct(out) / 2);
    const auto tangent = camera.undistort(pixel);
    extent = std::max(extent, tangent ? tangent->norm() : kMaxHalfExtent);
  }
  return std::min(extent, kMaxHalfExtent);
}

bool UndistortedView::fits(const CameraModel& camera) const {
  return camera.focal_px() == camera_.focal_px() && camera.aspect_ratio() == camera_.aspect_ratio() &&
         camera.distortion_xi() == camera_.distortion_xi() && camera.index_ratio() == camera_.index_ratio() &&
         camera.fluid_model() == camera_.fluid_model() &&
         camera.boundary().radius_px == camera_.boundary().radius_px &&
         camera.image_size_px() == camera_.image_size_px();
}

std::optional<Eigen::Vector2d> UndistortedView::view_from_pixel(const CameraModel& camera,
                                                                const Eigen::Vector2d& pixel) const {
  const auto tangent = camera.undistort(pixel);
  if (!tangent) return std::nullopt;
  return *tangent / half_extent_;
}

Eigen::Vector2d UndistortedView::pixel_from_view(const CameraModel& camera,
                                                 const Eigen::Vector2d& view) const {
  const Eigen::Array2d place = ((view.array() + 1) / 2).max(0.0).min(1.0) * (kNodes - 1);
  const Eigen::Array2i cell = place.cast<int>().min(kNodes - 2);
  const Eigen::Array2d share = place - cell.cast<double>();
  const auto node = [&](int row, int column) {
    const std::size_t i = 2 * (static_cast<std::size_t>(row) * kNodes + static_cast<std::size_t>(column));
    return Eigen::Vector2d(table_px_[i], table_px_[i + 1]);
  };
  const auto across = [&](int row) -> Eigen::Vector2d {
    return (1 - share.x()) * node(row, cell.x()) + share.x() * node(row, cell.x() + 1);
  };
  return camera.principal_point_px() + (1 - share.y()) * across(cell.y()) + share.y() * across(cell.y() + 1);
}

}  // namespace arthronaut::camera
