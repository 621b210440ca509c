#include "app/scene/scene_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::scene {

namespace {

double half_height(const SceneCamera& camera) {
  return std::tan(geometry::rad_from_deg(camera.view_angle_deg) / 2);
}

struct Direction {
  Eigen::Vector3d ahead, up;
};

Direction direction_of(ViewDirection view, const landmarks::AnatomicalAxes& axes) {
  switch (view) {
    case ViewDirection::Anterior:
      return {-axes.anterior, axes.proximal};
    case ViewDirection::Posterior:
      return {axes.anterior, axes.proximal};
    case ViewDirection::Medial:
    case ViewDirection::Notch:
      return {axes.lateral, axes.proximal};
    case ViewDirection::Lateral:
      return {-axes.lateral, axes.proximal};
    case ViewDirection::Distal:
      return {axes.proximal, axes.anterior};
    case ViewDirection::Plateau:
      return {-axes.proximal, axes.anterior};
  }
  throw InvalidInput("unknown view");
}

}  // namespace

CameraAxes axes_of(const SceneCamera& camera) {
  const Eigen::Vector3d ahead = (camera.focus_mm - camera.position_mm).normalized();
  const Eigen::Vector3d right = ahead.cross(camera.up).normalized();
  return {right, right.cross(ahead), ahead};
}

std::string_view to_text(ViewDirection view) {
  switch (view) {
    case ViewDirection::Anterior:
      return "anterior";
    case ViewDirection::Posterior:
      return "posterior";
    case ViewDirection::Medial:
      return "medial";
    case ViewDirection::Lateral:
      return "lateral";
    case ViewDirection::Distal:
      return "distal";
    case ViewDirection::Notch:
      return "notch";
    case ViewDirection::Plateau:
      return "plateau";
  }
  throw InvalidInput("unknown view");
}

SceneCamera look_from(ViewDirection view, bones::Side side, const geometry::Bounds& bounds, double aspect) {
  return look_from(view, landmarks::scanner_axes(side), bounds, aspect);
}

SceneCamera look_from(ViewDirection view, const landmarks::AnatomicalAxes& anatomy,
                      const geometry::Bounds& bounds, double aspect) {
  const Direction direction = direction_of(view, anatomy);
  SceneCamera camera = look_along(direction.ahead, bounds.center_mm(), 1.0, direction.up);
  const CameraAxes axes = axes_of(camera);
  const Eigen::Vector3d half = 0.5 * bounds.size_mm();
  const double half_width = half.dot(axes.right.cwiseAbs());
  const double half_tall = half.dot(axes.up.cwiseAbs());
  const double half_deep = half.dot(axes.ahead.cwiseAbs());
  const double needed = std::max(half_tall, half_width / std::max(aspect, 0.05));
  constexpr double kMargin = 1.06;
  const double distance = kMargin * needed / half_height(camera) + half_deep;
  camera.position_mm = camera.focus_mm - distance * axes.ahead;
  return camera;
}

SceneCamera look_along(const Eigen::Vector3d& direction, const Eigen::Vector3d& focus_mm, double distance_mm,
                       const Eigen::Vector3d& up_hint) {
  SceneCamera camera;
  camera.focus_mm = focus_mm;
  camera.position_mm = focus_mm - distance_mm * direction;
  Eigen::Vector3d up = up_hint - up_hint.dot(direction) * direction;
  if (up.norm() < 1e-6) up = direction.unitOrthogonal();
  camera.up = up.normalized();
  return camera;
}

SceneCamera orbited(const SceneCamera& camera, const Eigen::Vector2d& drag_px, double height_px) {
  const CameraAxes axes = axes_of(camera);
  constexpr double kTurnPerHeight = 1.2 * geometry::kPi;  // a drag over the whole height turns by 216 degrees
  const double scale = kTurnPerHeight / std::max(height_px, 1.0);
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(-drag_px.x() * scale, axes.up) * Eigen::AngleAxisd(-drag_px.y() * scale, axes.right))
          .toRotationMatrix();
  SceneCamera result = camera;
  result.position_mm = camera.focus_mm + turn * (camera.position_mm - camera.focus_mm);
  result.up = (turn * axes.up).normalized();
  return result;
}

SceneCamera panned(const SceneCamera& camera, const Eigen::Vector2d& drag_px, double height_px) {
  const CameraAxes axes = axes_of(camera);
  const double mm_per_px =
      2 * half_height(camera) * (camera.focus_mm - camera.position_mm).norm() / std::max(height_px, 1.0);
  const Eigen::Vector3d shift = mm_per_px * (-drag_px.x() * axes.right + drag_px.y() * axes.up);
  SceneCamera result = camera;
  result.position_mm += shift;
  result.focus_mm += shift;
  return result;
}

SceneCamera zoomed(const SceneCamera& camera, double steps) {
  constexpr double kNearest = 15, kFarthest = 3000;
  const double distance = (camera.focus_mm - camera.position_mm).norm();
  const double wanted = std::clamp(distance * std::pow(0.88, steps), kNearest, kFarthest);
  SceneCamera result = camera;
  result.position_mm = camera.focus_mm + (wanted / distance) * (camera.position_mm - camera.focus_mm);
  return result;
}

SceneRay ray_through(const SceneCamera& camera, const Eigen::Vector2d& pixel,
                     const Eigen::Vector2d& size_px) {
  const CameraAxes axes = axes_of(camera);
  const double scale = half_height(camera) / (0.5 * size_px.y());
  const Eigen::Vector2d offset = (pixel - 0.5 * size_px) * scale;
  return {camera.position_mm, (axes.ahead + offset.x() * axes.right - offset.y() * axes.up).normalized()};
}

std::optional<Eigen::Vector2d> project(const SceneCamera& camera, const Eigen::Vector3d& point_mm,
                                       const Eigen::Vector2d& size_px) {
  const CameraAxes axes = axes_of(camera);
  const Eigen::Vector3d from_eye = point_mm - camera.position_mm;
  const double depth = from_eye.dot(axes.ahead);
  if (depth <= 1e-6) return std::nullopt;
  const double scale = 0.5 * size_px.y() / half_height(camera) / depth;
  return Eigen::Vector2d(0.5 * size_px.x() + scale * from_eye.dot(axes.right),
                         0.5 * size_px.y() - scale * from_eye.dot(axes.up));
}

}  // namespace arthronaut::scene
