#include "navigation/simulator/holding.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::simulator {

namespace {

using Eigen::Vector3d;
using geometry::RigidTransform;

RigidTransform frame_from_axes(const Vector3d& x, const Vector3d& y, const Vector3d& z,
                               const Vector3d& origin) {
  Eigen::Matrix3d axes;
  axes << x, y, z;
  return {Eigen::Quaterniond(axes).normalized(), origin};
}

}  // namespace

RigidTransform bone_from_camera(const Vector3d& eye, const Vector3d& forward, const Vector3d& up) {
  const Vector3d z = forward.normalized(), x = z.cross(up).normalized();
  return frame_from_axes(x, z.cross(x), z, eye);
}

RigidTransform marker_facing(const Vector3d& center, const Vector3d& normal, const Vector3d& y) {
  const Vector3d z = normal.normalized(), x = y.cross(z).normalized();
  return frame_from_axes(x, z.cross(x), z, center);
}

Vector3d turned_towards(const Vector3d& normal, const Vector3d& wanted, double limit_rad) {
  const double angle = geometry::angle_between_rad(normal, wanted);
  if (angle <= limit_rad) return normal;
  const Vector3d axis = normal.cross(wanted).normalized();
  return Eigen::AngleAxisd(angle - limit_rad, axis) * normal;
}

std::optional<RigidTransform> hold_probe(const Vector3d& tip_in_probe_mm, const Vector3d& tip,
                                         const Vector3d& hold, const Vector3d& viewer) {
  const Vector3d in_marker = -tip_in_probe_mm;  // from tip to marker, in the marker's frame
  const double length = in_marker.norm();
  const Vector3d u = (hold - tip).normalized(), center = tip + length * u;
  const Vector3d to_viewer = (viewer - center).normalized();
  // The normal lies on a cone about u.
  const double cone = std::acos(std::clamp(in_marker.z() / length, -1.0, 1.0));
  const Vector3d across = to_viewer - to_viewer.dot(u) * u;
  if (across.norm() < 0.05) return std::nullopt;
  const Vector3d side = across.normalized();
  const auto normal_at = [&](double turn) -> Vector3d {
    return std::cos(cone) * u + std::sin(cone) * (Eigen::AngleAxisd(turn, u) * side);
  };
  double turn = 0;
  while (turn < 1.0 && geometry::angle_between_rad(normal_at(turn), to_viewer) < geometry::rad_from_deg(18))
    turn += 0.02;
  const Vector3d z = normal_at(turn);
  // u = R in_marker / length with in_marker in the plane of the marker's y and z (x is small): solve for y.
  const Vector3d y = (length * u - in_marker.z() * z).normalized();
  RigidTransform pose = marker_facing(center, z, y);
  pose.translation_mm = tip - pose.rotate(tip_in_probe_mm);
  return pose;
}

RigidTransform guide_pose(const tools::ToolAxis& axis, const Vector3d& point_mm, const Vector3d& direction,
                          const Vector3d& viewer_mm) {
  // The rotation that lays the tool's axis along `direction`, then the turn about it that shows the marker.
  const Vector3d bend = axis.direction.cross(direction);
  const Eigen::Quaterniond aligned(Eigen::AngleAxisd(
      geometry::angle_between_rad(axis.direction, direction),
      bend.norm() > 1e-9 ? Vector3d(bend.normalized()) : Vector3d(axis.direction.unitOrthogonal())));
  const Vector3d center = point_mm - aligned * axis.point_mm;
  const auto across = [&](const Vector3d& v) -> Vector3d {
    return (v - v.dot(direction) * direction).normalized();
  };
  const Vector3d is = across(aligned * Vector3d::UnitZ()), wanted = across(viewer_mm - center);
  const double turn = std::atan2(direction.dot(is.cross(wanted)), is.dot(wanted));
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(turn + geometry::rad_from_deg(14), direction)) * aligned;
  return {rotation.normalized(), point_mm - rotation * axis.point_mm};
}

}  // namespace arthronaut::simulator
