#include "app/plan/tunnel_moves.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "planning/geometry/rigid_transform.h"
#include "planning/tunnels/diameter_range.h"

namespace arthronaut::plan {

namespace {

Eigen::Vector3d turned_towards(const Eigen::Vector3d& direction, const Eigen::Vector3d& side,
                               double angle_deg) {
  const Eigen::Vector3d across = side - side.dot(direction) * direction;
  if (across.norm() < 0.05) return direction;  // it points that way: no turn brings it further
  const double angle = geometry::rad_from_deg(angle_deg);
  return (std::cos(angle) * direction + std::sin(angle) * across.normalized()).normalized();
}

}  // namespace

tunnels::Tunnel with_entry_at(const tunnels::Tunnel& tunnel, const Eigen::Vector3d& entry_mm) {
  tunnels::Tunnel result = tunnel;
  result.entry_mm = entry_mm;
  return result;
}

tunnels::Tunnel with_entry_slid(const tunnels::Tunnel& tunnel, const scene::SceneCamera& camera,
                                const Eigen::Vector2d& right_up_mm, const geometry::Surface& bone) {
  const scene::CameraAxes axes = axes_of(camera);
  tunnels::Tunnel result = tunnel;
  result.entry_mm =
      bone.closest_point(tunnel.entry_mm + right_up_mm.x() * axes.right + right_up_mm.y() * axes.up).point_mm;
  return result;
}

tunnels::Tunnel turned(const tunnels::Tunnel& tunnel, const scene::SceneCamera& camera,
                       const Eigen::Vector2d& right_up_deg) {
  const scene::CameraAxes axes = axes_of(camera);
  tunnels::Tunnel result = tunnel;
  result.direction = turned_towards(result.direction, axes.right, right_up_deg.x());
  result.direction = turned_towards(result.direction, axes.up, right_up_deg.y());
  return result;
}

tunnels::Tunnel aimed_at(const tunnels::Tunnel& tunnel, const Eigen::Vector3d& point_mm) {
  const Eigen::Vector3d direction = point_mm - tunnel.entry_mm;
  tunnels::Tunnel result = tunnel;
  if (direction.norm() > 1) result.direction = direction.normalized();
  return result;
}

tunnels::Tunnel for_graft(const tunnels::Tunnel& tunnel, norms::Bundle graft) {
  constexpr double kSame_mm = 0.05;
  tunnels::Tunnel result = tunnel;
  result.bundle = graft;
  if (std::abs(tunnel.diameter_mm - tunnels::usual_diameter_mm(tunnel.bundle)) < kSame_mm)
    result.diameter_mm = tunnels::usual_diameter_mm(graft);
  return result;
}

tunnels::Tunnel with_diameter(const tunnels::Tunnel& tunnel, double diameter_mm) {
  tunnels::Tunnel result = tunnel;
  result.diameter_mm = std::clamp(diameter_mm, tunnels::kLeastDiameter_mm, tunnels::kGreatestDiameter_mm);
  return result;
}

std::optional<Eigen::Vector3d> moved_in_view(const scene::SceneCamera& camera, const scene::SceneRay& ray,
                                             const Eigen::Vector3d& point_mm) {
  const Eigen::Vector3d ahead = axes_of(camera).ahead;
  const double along = ray.direction.dot(ahead);
  if (along < 1e-6) return std::nullopt;
  return ray.origin_mm + (point_mm - ray.origin_mm).dot(ahead) / along * ray.direction;
}

}  // namespace arthronaut::plan
