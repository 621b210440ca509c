#include "planning/tunnels/tunnel_mouth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/tunnels/axis_view.h"

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSameFaceCosine = 0.70710678118654752;  // 45 deg
// Ellipses of a tunnel that grazes the bone are cut off at 80 deg from square: five and a half diameters
// long.
constexpr double kLeastFacing = 0.17364817766693033;

// The station at which a line parallel to the axis goes through the triangle; empty where it passes it.
std::optional<double> station_on(const AxisTriangle& triangle, const Vector2d& at) {
  const auto cross = [](const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); };
  const auto& c = triangle.corners_mm;
  const Vector2d p = c[0].head<2>() - at, q = c[1].head<2>() - at, r = c[2].head<2>() - at;
  const double a = cross(q, r), b = cross(r, p), d = cross(p, q), sum = a + b + d;
  const bool inside = sum > 0 ? a >= 0 && b >= 0 && d >= 0 : a <= 0 && b <= 0 && d <= 0;
  if (sum == 0 || !inside) return std::nullopt;
  return (a * c[0].z() + b * c[1].z() + d * c[2].z()) / sum;
}

// Points of a disc, each of the same share of its area.
std::vector<Vector2d> samples_of_disc(double radius_mm) {
  constexpr int kRings = 6, kPerRing = 24;
  std::vector<Vector2d> samples;
  for (int ring = 0; ring < kRings; ++ring) {
    const double at_mm = radius_mm * std::sqrt((ring + 0.5) / kRings);
    for (int k = 0; k < kPerRing; ++k) {
      const double angle = 2 * geometry::kPi * (k + 0.5 * (ring % 2)) / kPerRing;
      samples.emplace_back(at_mm * std::cos(angle), at_mm * std::sin(angle));
    }
  }
  return samples;
}

}  // namespace

TunnelMouth mouth_at(const AxisView& view, double station_mm, double diameter_mm, bool is_entry) {
  const double radius_mm = 0.5 * diameter_mm, reach_mm = 4 * diameter_mm, sense = is_entry ? -1 : 1;
  std::vector<const AxisTriangle*> facing;
  for (const AxisTriangle& triangle : view.triangles()) {
    if (triangle.nearest_mm < radius_mm && sense * triangle.normal.z() > 0) facing.push_back(&triangle);
  }
  std::vector<Vector3d> normals;
  for (const Vector2d& at : samples_of_disc(radius_mm)) {
    const AxisTriangle* nearest = nullptr;
    double off_mm = reach_mm;
    for (const AxisTriangle* triangle : facing) {
      const auto station = station_on(*triangle, at);
      if (!station || std::abs(*station - station_mm) >= off_mm) continue;
      off_mm = std::abs(*station - station_mm);
      nearest = triangle;
    }
    if (nearest)
      normals.push_back((nearest->smooth_normals[0] + nearest->smooth_normals[1] + nearest->smooth_normals[2])
                            .normalized());
  }
  Vector3d mean = Vector3d::Zero(), face = Vector3d::Zero();
  for (const Vector3d& normal : normals) mean += normal;
  mean = mean.norm() > 0 ? Vector3d(mean.normalized()) : Vector3d(0, 0, sense);
  for (const Vector3d& normal : normals)
    if (normal.dot(mean) > kSameFaceCosine) face += normal;
  face = face.norm() > 0 ? Vector3d(face.normalized()) : mean;

  const double facing_cosine = std::clamp(sense * face.z(), kLeastFacing, 1.0);
  TunnelMouth mouth;
  mouth.at_mm = view.to_bone({0, 0, station_mm});
  mouth.normal = view.direction_to_bone(face);
  // Along the face, as near to the axis as it gets; any way in the face where the tunnel stands square on.
  const Vector3d axis_in_face = Vector3d::UnitZ() - face.z() * face;
  mouth.long_axis = view.direction_to_bone(axis_in_face.norm() > 1e-9 ? Vector3d(axis_in_face.normalized())
                                                                      : face.unitOrthogonal());
  mouth.short_mm = diameter_mm;
  mouth.long_mm = diameter_mm / facing_cosine;
  mouth.area_mm2 = 0.25 * geometry::kPi * mouth.short_mm * mouth.long_mm;
  mouth.angle_to_surface_deg = geometry::deg_from_rad(std::asin(std::clamp(sense * face.z(), -1.0, 1.0)));
  return mouth;
}

}  // namespace arthronaut::tunnels
