#include "planning/tunnels/tunnel_pair.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector3d;

struct Cylinder {
  Vector3d from_mm, along;
  double length_mm, radius_mm;

  [[nodiscard]] Vector3d nearest(const Vector3d& point) const {
    const Vector3d offset = point - from_mm;
    const double station = offset.dot(along);
    const Vector3d across = offset - station * along;
    const double off = across.norm();
    return from_mm + std::clamp(station, 0.0, length_mm) * along +
           (off > radius_mm ? Vector3d(across * (radius_mm / off)) : across);
  }
};

struct Nearest {
  Vector3d on_first, on_second;
};

// Of the two axes, by the closed form for segments (Ericson 2005, 5.1.9).
Nearest of_axes(const Cylinder& a, const Cylinder& b) {
  const Vector3d between = a.from_mm - b.from_mm;
  const double cosine = a.along.dot(b.along), da = a.along.dot(between), db = b.along.dot(between);
  const double across = 1 - cosine * cosine;
  double s = across > 1e-12 ? std::clamp((cosine * db - da) / across, 0.0, a.length_mm) : 0.0;
  const double t = std::clamp(cosine * s + db, 0.0, b.length_mm);
  s = std::clamp(cosine * t - da, 0.0, a.length_mm);
  return {a.from_mm + s * a.along, b.from_mm + t * b.along};
}

}  // namespace

TunnelGap gap_between(const Tunnel& first, const TunnelGeometry& first_measured, const Tunnel& second,
                      const TunnelGeometry& second_measured) {
  const Cylinder a{first_measured.entry_on_surface_mm, first.direction, first_measured.length_mm,
                   0.5 * first.diameter_mm},
      b{second_measured.entry_on_surface_mm, second.direction, second_measured.length_mm,
        0.5 * second.diameter_mm};
  const Nearest axes = of_axes(a, b);
  // Both are convex: the nearest points follow from going to and fro, with Nesterov's momentum, since to and
  // fro alone creeps along sides that are nearly parallel.
  constexpr int kRounds = 400;
  Vector3d x = a.nearest(axes.on_second), ahead = x;
  double weight = 1;
  for (int round = 0; round < kRounds; ++round) {
    const Vector3d next = a.nearest(b.nearest(ahead));
    const double next_weight = 0.5 * (1 + std::sqrt(1 + 4 * weight * weight));
    const Vector3d step = next - x;
    ahead = next + (weight - 1) / next_weight * step;
    x = next;
    weight = next_weight;
    if (step.norm() < 1e-9 && round > 10) break;
  }
  const Vector3d y = b.nearest(x);
  constexpr double kTouch_mm = 1e-6;
  if (const double gap = (x - y).norm(); gap > kTouch_mm) return {gap, 0.5 * (x + y)};
  return {std::min(0.0, (axes.on_first - axes.on_second).norm() - a.radius_mm - b.radius_mm),
          0.5 * (axes.on_first + axes.on_second)};
}

}  // namespace arthronaut::tunnels
