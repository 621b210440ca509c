#include "planning/tunnels/portal.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector3d;

bool is_clear(const Vector3d& from, const Vector3d& entry, double radius_mm, const geometry::Surface& femur) {
  constexpr double kBeforeEntry_mm = 3, kStep_mm = 1.5;
  const double length = (entry - from).norm();
  const Vector3d along = (entry - from) / std::max(length, 1e-9);
  for (double at = 0; at < length - kBeforeEntry_mm - radius_mm; at += kStep_mm)
    if (femur.signed_distance_mm(from + at * along) < radius_mm) return false;
  return length > 0;
}

}  // namespace

Portal anteromedial_portal(const graft::FlexionAxis& axis, const landmarks::AnatomicalAxes& axes) {
  return {.at_mm =
              axis.point_mm + axis.scale() * (-24 * axes.lateral + 35 * axes.anterior - 15 * axes.proximal)};
}

std::vector<PortalAim> portal_aims(const Vector3d& entry_mm, double diameter_mm, const Portal& portal,
                                   const graft::FlexionAxis& axis, const geometry::Surface& femur) {
  constexpr int kRim = 8;
  constexpr double kFlexionStep_deg = 5;
  std::vector<PortalAim> aims;
  for (double flexion = portal.least_flexion_deg; flexion < portal.greatest_flexion_deg + 1e-9;
       flexion += kFlexionStep_deg) {
    const Vector3d middle = graft::femur_from_tibia(axis, geometry::rad_from_deg(flexion)) * portal.at_mm;
    const Vector3d straight = (entry_mm - middle).normalized(), side = straight.unitOrthogonal(),
                   up = straight.cross(side);
    for (int k = -1; k < kRim; ++k) {
      const double angle = 2 * geometry::kPi * k / kRim;
      const Vector3d from =
          k < 0 ? middle
                : Vector3d(middle + portal.radius_mm * (std::cos(angle) * side + std::sin(angle) * up));
      aims.push_back({.direction = (entry_mm - from).normalized(),
                      .flexion_deg = flexion,
                      .is_clear = is_clear(from, entry_mm, 0.5 * diameter_mm, femur)});
    }
  }
  return aims;
}

double off_portal_deg(const Vector3d& direction, const std::vector<PortalAim>& aims) {
  double least_deg = 180;
  for (const PortalAim& aim : aims)
    if (aim.is_clear)
      least_deg =
          std::min(least_deg, geometry::deg_from_rad(geometry::angle_between_rad(direction, aim.direction)));
  return least_deg;
}

std::vector<Vector3d> outside_in_aims(const Tunnel& at_entry, const geometry::Surface& femur,
                                      const PlanSurroundings& surroundings, const PlanNorms& norms,
                                      const std::function<bool()>& is_cancelled) {
  std::vector<Vector3d> aims;
  if (!surroundings.axes) return aims;
  const landmarks::AnatomicalAxes& axes = *surroundings.axes;
  constexpr double kStep_deg = 7.5;
  for (double up_deg = -75; up_deg <= 75; up_deg += kStep_deg) {
    for (double forward_deg = -75; forward_deg <= 75; forward_deg += kStep_deg) {
      if (is_cancelled && is_cancelled()) return aims;
      if (std::hypot(up_deg, forward_deg) > 75) continue;
      const double up = geometry::rad_from_deg(up_deg), forward = geometry::rad_from_deg(forward_deg);
      Tunnel tunnel = at_entry;
      tunnel.direction =
          (std::cos(up) * std::cos(forward) * axes.lateral + std::sin(forward) * axes.anterior +
           std::sin(up) * std::cos(forward) * axes.proximal)
              .normalized();
      const TunnelGeometry measured = measure(tunnel, femur);
      if (!measured.enters_bone || measured.wall_mm < norms.breaking_wall_mm ||
          measured.length_mm < norms.short_femoral_tunnel_mm ||
          measured.length_mm > norms.long_femoral_tunnel_mm ||
          femoral_exit(femur, measured, axes, surroundings.extents) != FemoralExit::LateralCortex)
        continue;
      const auto epicondyle = surroundings.landmarks.find("lateral_epicondyle");
      if (epicondyle != surroundings.landmarks.end() &&
          (measured.exit_mm - epicondyle->second).norm() < 0.5 * measured.exit.long_mm)
        continue;
      aims.push_back(tunnel.direction);
    }
  }
  return aims;
}

}  // namespace arthronaut::tunnels
