#include "app/plan/tunnel_planes.h"

#include <Eigen/Geometry>
#include <cmath>

namespace arthronaut::plan {

namespace {

using Eigen::Vector3d;

// Up in the picture is `up`, as far as the plane of that normal allows; else the other direction.
PictureAxes upright(const Vector3d& normal, const Vector3d& up, const Vector3d& otherwise) {
  Vector3d page_up = up - up.dot(normal) * normal;
  page_up = page_up.norm() > 0.1 ? Vector3d(page_up.normalized()) : otherwise;
  return {(-page_up).cross(normal).normalized(), -page_up};
}

// Square to the axis and to each other; a plane that is not turned holds `upwards`.
struct AcrossAxis {
  Vector3d upwards, across;
};
AcrossAxis across_axis(const TunnelAxis& axis) {
  Vector3d across = axis.direction.cross(axis.up);
  across = across.norm() > 0.1 ? Vector3d(across.normalized()) : axis.direction.unitOrthogonal();
  return {across.cross(axis.direction), across};
}

}  // namespace

TunnelPlanes tunnel_planes(const TunnelAxis& axis, double turned_rad) {
  const Vector3d& direction = axis.direction;
  const auto [upwards, across] = across_axis(axis);
  // Beside the axis that lies in the plane.
  const auto along = [&, &upwards = upwards, &across = across](double angle_rad) {
    const Vector3d in_plane = std::cos(angle_rad) * upwards + std::sin(angle_rad) * across;
    return upright(direction.cross(in_plane).normalized(), axis.up, direction);
  };
  constexpr double kQuarter_rad = 1.57079632679489662;
  return {upright(direction, axis.up, upwards), along(turned_rad), along(turned_rad + kQuarter_rad)};
}

double turned_to_hold_rad(const TunnelAxis& axis, const Vector3d& point_mm) {
  const auto [upwards, across] = across_axis(axis);
  const Vector3d off_mm = point_mm - on_axis(axis, point_mm);
  const double x = off_mm.dot(upwards), y = off_mm.dot(across);
  // Half a turn shows the same plane.
  return x == 0 && y == 0 ? 0 : x < 0 ? std::atan2(-y, -x) : std::atan2(y, x);
}

Vector3d on_axis(const TunnelAxis& axis, const Vector3d& point_mm) {
  return axis.entry_mm + (point_mm - axis.entry_mm).dot(axis.direction) * axis.direction;
}

}  // namespace arthronaut::plan
