#include "planning/graft/roof_clearance.h"

#include <Eigen/Geometry>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::graft {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Across a line that runs upwards, with x anterior and y proximal.
Vector2d forwards_of(const Vector2d& upwards) { return {upwards.y(), -upwards.x()}; }

}  // namespace

std::optional<RoofClearance> roof_clearance(const RoofQuery& query) {
  const auto in_view = [&](const Vector3d& v) {
    return Vector2d(v.dot(query.femur_axes.anterior), v.dot(query.femur_axes.proximal));
  };
  const Vector2d outlet = in_view(query.blumensaat_anterior_mm),
                 roof = in_view(query.blumensaat_posterior_mm) - outlet;
  const Vector2d tunnel = -in_view(query.into_tibia), opening = in_view(query.tibial_opening_mm);
  if (roof.norm() < 5 || tunnel.norm() < 0.2) return std::nullopt;
  const Vector2d up_tunnel = tunnel.normalized(), up_roof = roof.normalized();
  const double radius_mm = 0.5 * query.diameter_mm;
  RoofClearance clearance;
  clearance.outlet_mm = (outlet - opening).dot(forwards_of(up_tunnel)) - radius_mm;
  // The tunnel's anterior border at its opening: straight across the tunnel, whatever slope the plateau has.
  const Vector2d border = opening + radius_mm * forwards_of(up_tunnel);
  clearance.opening_mm = (outlet - border).dot(forwards_of(up_roof));
  return clearance;
}

}  // namespace arthronaut::graft
