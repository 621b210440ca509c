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

struct DenseWall {
  double thickness_mm = std::numeric_limits<double>::infinity();
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
};

inline DenseWall dense_wall(const tunnels::Tunnel& tunnel, const tunnels::TunnelGeometry& measured,
                            const geometry::Surface& bone, int half_planes, double step_mm) {
  const double radius = 0.5 * tunnel.diameter_mm, facing = std::sin(geometry::rad_from_deg(15)),
               reach = radius / std::tan(geometry::rad_from_deg(15)),
               turn = std::cos(geometry::rad_from_deg(45));
  const Eigen::Vector3d &d = tunnel.direction, side = d.unitOrthogonal(), up = d.cross(side);
  const int rough = static_cast<int>(std::lround(1.0 / step_mm));
  DenseWall found;
  for (int k = 0; k < half_planes; ++k) {
    const double angle = 2 * geometry::kPi * k / half_planes;
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
      const double from = s < 0 || s > measured.length_mm ? radius : 0;
      Line line;
      for (const auto& hit : bone.all_hits(axis_at(s) + from * out, out)) {
        if (hit.normal.dot(out) <= 0) continue;
        line.radius = from + hit.distance_mm;
        line.entry_lip = -hit.normal.dot(d) > facing && hit.normal.dot(measured.entry.normal) > turn;
        line.exit_lip = hit.normal.dot(d) > facing && hit.normal.dot(measured.exit.normal) > turn;
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
