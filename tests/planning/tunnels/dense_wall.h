// The wall as planning/tunnels/tunnel_wall.h defines it, by brute force: a dense grid of exact rays, one
// after the other, by the queries of geometry::Surface alone. Slow; for tests.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::test {

// Half planes at `count` angles from one to another, lines `step_mm` apart. Angles are as angle_of counts
// them.
struct DenseGrid {
  double from_rad = 0, to_rad = 2 * geometry::kPi;
  int count = 180;
  double step_mm = 0.05;
  double roughness_mm = 1.0;  // what is no lip for less than this does not end it
};

struct DenseWall {
  double thickness_mm = std::numeric_limits<double>::infinity();
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
};

// Of the surface at a hit, laid linearly over its triangle. The mesh must have been given clean.
inline Eigen::Vector3d smooth_normal(const geometry::Surface& bone, const geometry::RayHit& hit) {
  const auto& corners = bone.mesh().triangles[static_cast<std::size_t>(hit.triangle)];
  const auto at = [&](int k) { return bone.mesh().vertices_mm[static_cast<std::size_t>(corners[k])]; };
  Eigen::Matrix3d edges;
  edges << at(0), at(1), at(2);
  Eigen::Matrix<double, 4, 3> sums;  // barycentric: the corners' mix, of weight 1
  sums << edges, Eigen::RowVector3d::Ones();
  Eigen::Vector4d point;
  point << hit.point_mm, 1;
  const Eigen::Vector3d weights = sums.colPivHouseholderQr().solve(point);
  const auto& normals = bone.smooth_normals(hit.triangle);
  return weights[0] * normals[0] + weights[1] * normals[1] + weights[2] * normals[2];
}

inline double angle_of(const tunnels::Tunnel& tunnel, const tunnels::TunnelGeometry& measured,
                       const Eigen::Vector3d& point_mm) {
  const Eigen::Vector3d side = tunnel.direction.unitOrthogonal(), up = tunnel.direction.cross(side),
                        away = point_mm - measured.entry_on_surface_mm;
  return std::atan2(away.dot(up), away.dot(side));
}

inline DenseWall dense_wall(const tunnels::Tunnel& tunnel, const tunnels::TunnelGeometry& measured,
                            const geometry::Surface& bone, const DenseGrid& grid) {
  const double step_mm = grid.step_mm, radius = 0.5 * tunnel.diameter_mm,
               facing = std::sin(geometry::rad_from_deg(15)),
               reach = radius / std::tan(geometry::rad_from_deg(15)),
               turn = std::cos(geometry::rad_from_deg(45));
  const Eigen::Vector3d &d = tunnel.direction, side = d.unitOrthogonal(), up = d.cross(side);
  const int rough = static_cast<int>(std::lround(grid.roughness_mm / step_mm));
  DenseWall found;
  for (int k = 0; k < grid.count; ++k) {
    const double angle = grid.from_rad + (grid.to_rad - grid.from_rad) * k / grid.count;
    const Eigen::Vector3d out = std::cos(angle) * side + std::sin(angle) * up;
    const auto axis_at = [&](double s) { return Eigen::Vector3d(measured.entry_on_surface_mm + s * d); };
    const auto is_inside = [&](double s) { return bone.signed_distance_mm(axis_at(s) + radius * out) < 0; };
    double begins = 0, ends = measured.length_mm;
    if (is_inside(1e-3))
      while (begins > -reach && is_inside(begins - step_mm)) begins -= step_mm;
    if (is_inside(ends - 1e-3))
      while (ends < measured.length_mm + reach && is_inside(ends + step_mm)) ends += step_mm;
    struct Line {
      double radius = std::numeric_limits<double>::infinity();
      bool entry_lip = false, exit_lip = false;
      Eigen::Vector3d at_mm;
    };
    std::vector<Line> lines;
    for (double s = begins + 0.5 * step_mm; s < ends; s += step_mm) {
      // From the tunnel's side outwards where it lies in bone, else back towards the axis.
      const bool in_bone = is_inside(s);
      const Eigen::Vector3d away = in_bone ? out : Eigen::Vector3d(-out);
      Line line;
      for (const auto& hit : bone.all_hits(axis_at(s) + radius * out, away)) {
        line.radius = radius + (in_bone ? hit.distance_mm : -hit.distance_mm);
        const Eigen::Vector3d faces = smooth_normal(bone, hit);
        line.entry_lip = -faces.dot(d) > facing && faces.dot(measured.entry.normal) > turn;
        line.exit_lip = faces.dot(d) > facing && faces.dot(measured.exit.normal) > turn;
        line.at_mm = hit.point_mm;
        break;
      }
      lines.push_back(line);
    }
    const int count = static_cast<int>(lines.size());
    const auto beyond_lip = [&](bool from_entry) {
      int run = 0;
      for (int i = 0; i < count; ++i) {
        const Line& line = lines[static_cast<std::size_t>(from_entry ? i : count - 1 - i)];
        run = (from_entry ? line.entry_lip : line.exit_lip) ? 0 : run + 1;
        if (run >= rough) return i - run + 1;
      }
      return count;
    };
    const int first = beyond_lip(true), last = count - 1 - beyond_lip(false);
    for (int i = first; i <= last; ++i) {
      const Line& line = lines[static_cast<std::size_t>(i)];
      if (line.radius - radius < found.thickness_mm) found = {line.radius - radius, line.at_mm};
    }
  }
  return found;
}

}  // namespace arthronaut::test
