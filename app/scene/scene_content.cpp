#include "app/scene/scene_content.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace arthronaut::scene {

namespace {

constexpr double kBeforeEntry_mm = 1.0;  // a tube starts just above the bone so that its mouth is seen

LineItem ring_about(const Eigen::Vector3d& center, const Eigen::Vector3d& axis, double diameter_mm,
                    double line_mm, const Color& color) {
  LineItem ring{{}, line_mm, true, color, true};
  const Eigen::Vector3d side = axis.unitOrthogonal(), other = axis.cross(side);
  constexpr int kPoints = 48;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints;
    ring.points_mm.push_back(center + 0.5 * diameter_mm * (std::cos(angle) * side + std::sin(angle) * other));
  }
  return ring;
}

}  // namespace

void add_planned_tunnel(SceneContent& content, const tunnels::Tunnel& tunnel, double length_mm,
                        const Color& color) {
  const Eigen::Vector3d from = tunnel.entry_mm - kBeforeEntry_mm * tunnel.direction;
  const Eigen::Vector3d to = tunnel.entry_mm + (length_mm + kBeforeEntry_mm) * tunnel.direction;
  content.rods.push_back({from, to, tunnel.diameter_mm, tunnel.diameter_mm, color, true});
  content.lines.push_back(ring_about(from, tunnel.direction, tunnel.diameter_mm + 1.6, 0.8, {1, 1, 1}));
  // The axis, drawn out on both sides: where a drill comes from and where it goes.
  content.lines.push_back(
      {{tunnel.entry_mm - 14 * tunnel.direction, to + 8 * tunnel.direction}, 0.5, false, color, true});
}

void add_achieved_tunnel(SceneContent& content, const tunnels::Tunnel& tunnel, double length_mm) {
  constexpr double kBand_mm = 2.5;
  constexpr Color kDark{0.35F, 0.22F, 0.0F};
  const double diameter = tunnel.diameter_mm * 1.02;  // a hair wider, so that it is seen where both lie alike
  int band = 0;
  for (double at = -kBeforeEntry_mm; at < length_mm; at += kBand_mm, ++band) {
    const double end = std::min(at + kBand_mm, length_mm);
    content.rods.push_back({tunnel.entry_mm + at * tunnel.direction, tunnel.entry_mm + end * tunnel.direction,
                            diameter, diameter, band % 2 == 0 ? kAchievedColor : kDark, true});
  }
}

void add_guide(SceneContent& content, const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction,
               double ahead_mm) {
  constexpr double kCone_mm = 7, kRod_mm = 45;
  const Eigen::Vector3d cone_base = tip_mm - kCone_mm * direction;
  content.rods.push_back({cone_base, tip_mm, 4.0, 0.2, kGuideColor, false});
  content.rods.push_back({cone_base - kRod_mm * direction, cone_base, 2.4, 2.4, kGuideColor, false});
  content.lines.push_back({{tip_mm, tip_mm + ahead_mm * direction}, 0.6, false, kGuideColor, true});
}

void add_curve_points(SceneContent& content, const std::vector<Eigen::Vector3d>& points_mm) {
  constexpr double kHop_mm = 1.5;
  LineItem line{{}, 0.7, false, kCurveColor, false};
  const auto flush = [&] {
    if (line.points_mm.size() > 1) content.lines.push_back(line);
    line.points_mm.clear();
  };
  for (const Eigen::Vector3d& point : points_mm) {
    if (!line.points_mm.empty() && (point - line.points_mm.back()).norm() > kHop_mm) flush();
    // A tube needs no more than a point every 0.3 mm.
    if (line.points_mm.empty() || (point - line.points_mm.back()).norm() > 0.3)
      line.points_mm.push_back(point);
  }
  flush();
}

}  // namespace arthronaut::scene
