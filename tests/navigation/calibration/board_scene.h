// Checkerboards seen through a known arthroscope: corners and pictures drawn from their truth.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "navigation/calibration/calibration.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::calibration {

inline camera::Calibration true_scope() {
  camera::Calibration c;
  c.image_size_px = {1920, 1080};
  c.focal_px = 590;
  c.principal_point_px = {962, 541.5};
  c.distortion_xi = -0.30;
  c.rotation_center_px = {957, 537};
  c.reference_mark_angle_deg = 271.3;
  c.boundary = {{960.5, 540.2}, 531};
  return c;
}

// A board whose corner (0, 0) lies on the axis, tilted about a direction in the image.
inline geometry::RigidTransform board_pose(double distance_mm, double tilt_deg, double tilt_axis_deg,
                                           double spin_deg) {
  const double axis = geometry::rad_from_deg(tilt_axis_deg);
  const Eigen::AngleAxisd tilt(geometry::rad_from_deg(tilt_deg),
                               Eigen::Vector3d(std::cos(axis), std::sin(axis), 0));
  const Eigen::AngleAxisd spin(geometry::rad_from_deg(spin_deg), Eigen::Vector3d::UnitZ());
  return {Eigen::Quaterniond(tilt * spin), {0.4, -0.3, distance_mm}};
}

struct BoardView {
  geometry::RigidTransform camera_from_board;
  double lens_angle_deg = 0;
};

// Corners with Gaussian noise, out to a share of the view's radius, and what the lens tracker would report.
inline CalibrationPicture picture_of(const camera::Calibration& scope, const BoardView& view,
                                     double square_mm, double corner_sigma_px, double mark_sigma_deg,
                                     std::mt19937& random, double reach = 0.92) {
  std::normal_distribution<double> normal;
  const double alpha = geometry::rad_from_deg(view.lens_angle_deg);
  const camera::CameraModel model(scope, alpha, scope.refractive_index);
  CalibrationPicture picture;
  picture.name = "board at " + std::to_string(static_cast<int>(view.lens_angle_deg)) + " degrees";
  picture.size_px = scope.image_size_px;
  for (int c = -30; c <= 30; ++c)
    for (int r = -30; r <= 30; ++r) {
      const auto pixel =
          model.project(view.camera_from_board * Eigen::Vector3d(c * square_mm, r * square_mm, 0));
      if (!pixel || (*pixel - model.boundary().center_px).norm() > reach * scope.boundary.radius_px) continue;
      picture.board.corners.push_back(
          {{c, r}, *pixel + corner_sigma_px * Eigen::Vector2d(normal(random), normal(random))});
    }
  picture.lens.circle_found = true;
  picture.lens.circle = model.boundary();
  picture.lens.circle.center_px += 0.1 * Eigen::Vector2d(normal(random), normal(random));
  picture.lens.mark = lens::MarkState::Found;
  picture.lens.mark_angle_deg = std::fmod(
      scope.reference_mark_angle_deg + view.lens_angle_deg + 720 + mark_sigma_deg * normal(random), 360.0);
  return picture;
}

// An 8-bit picture of the board, 3 x 3 samples over 1.5 px (as optics blur; fewer alias in small squares),
// gamma 2.2, shaded towards the rim, with noise.
struct GrayPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> gray;
  [[nodiscard]] camera::GrayView view() const { return {gray.data(), width, height, width}; }
};

inline GrayPicture draw_board(const camera::Calibration& scope, const BoardView& view, double square_mm,
                              double noise, unsigned seed) {
  const camera::CameraModel model(scope, geometry::rad_from_deg(view.lens_angle_deg), scope.refractive_index);
  const geometry::RigidTransform board_from_camera = view.camera_from_board.inverse();
  GrayPicture picture{scope.image_size_px.x(), scope.image_size_px.y(), {}};
  picture.gray.resize(static_cast<std::size_t>(picture.width) * picture.height);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, noise);
  const double mark_rad = geometry::rad_from_deg(scope.reference_mark_angle_deg + view.lens_angle_deg);
  const auto light_at = [&](const Eigen::Vector2d& pixel) {
    const Eigen::Vector2d d = pixel - model.boundary().center_px;
    const double off_deg = std::abs(
        geometry::deg_from_rad(std::remainder(std::atan2(d.y(), d.x()) - mark_rad, 2 * geometry::kPi)));
    const double rim = scope.boundary.radius_px * (1 - 0.04 * std::max(0.0, 1 - off_deg / 2.1));
    if (d.norm() > rim) return 0.0;
    const auto tangent = model.undistort(pixel);
    if (!tangent) return 0.0;
    const Eigen::Vector3d origin = board_from_camera.translation_mm;
    const Eigen::Vector3d ray = board_from_camera.rotate({tangent->x(), tangent->y(), 1});
    const double t = -origin.z() / ray.z();
    const double x = (origin + t * ray).x() / square_mm, y = (origin + t * ray).y() / square_mm;
    const bool is_black = (static_cast<long>(std::floor(x)) + static_cast<long>(std::floor(y))) % 2 == 0;
    const double shade = 1 - 0.7 * d.squaredNorm() / (rim * rim);
    return shade * (is_black ? 0.03 : 0.6);
  };
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      double light = 0;
      if ((Eigen::Vector2d(x, y) - model.boundary().center_px).norm() < scope.boundary.radius_px + 2)
        for (const double dy : {-0.5, 0.0, 0.5})
          for (const double dx : {-0.5, 0.0, 0.5}) light += light_at({x + dx, y + dy}) / 9;
      const double value = 255 * std::pow(light, 1 / 2.2) + 3 + normal(random);
      picture.gray[static_cast<std::size_t>(y) * picture.width + x] =
          static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
    }
  return picture;
}

}  // namespace arthronaut::calibration
