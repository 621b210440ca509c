#include "planning/tunnels/entry_map.h"

#include <Eigen/Geometry>
#include <cmath>

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector3d;
using Verdict = PlanCheck::Verdict;

void take(const std::vector<PlanCheck>& checks, EntrySample& sample) {
  for (const PlanCheck& check : checks) {
    const bool is_worse = (check.verdict == Verdict::Wrong && sample.verdict != Verdict::Wrong) ||
                          (check.verdict == Verdict::Look && sample.verdict == Verdict::Fine);
    if (!is_worse) continue;
    sample.verdict = check.verdict;
    sample.reason = check.name + ": " + check.text;
  }
}

}  // namespace

std::vector<Vector3d> entries_around(const geometry::Surface& bone, const Vector3d& about_mm,
                                     double radius_mm, double spacing_mm) {
  std::vector<Vector3d> entries;
  if (!(spacing_mm > 0)) return entries;
  const geometry::SurfacePoint middle = bone.closest_point(about_mm);
  const Vector3d side = middle.normal.unitOrthogonal(), up = middle.normal.cross(side);
  const int steps = static_cast<int>(std::floor(radius_mm / spacing_mm));
  for (int i = -steps; i <= steps; ++i) {
    for (int k = -steps; k <= steps; ++k) {
      const Vector3d off = spacing_mm * (i * side + k * up);
      if (off.norm() > radius_mm) continue;
      // From above, but not from beyond the other side of a notch.
      constexpr double kAbove_mm = 6;
      const auto hit = bone.first_hit(middle.point_mm + off + kAbove_mm * middle.normal, -middle.normal);
      if (hit && hit->distance_mm < 2 * kAbove_mm && hit->normal.dot(middle.normal) > 0)
        entries.push_back(hit->point_mm);
    }
  }
  return entries;
}

std::vector<EntrySample> map_entries(const EntryMapRequest& request, const geometry::Surface& bone,
                                     const PlanSurroundings& surroundings, const PlanNorms& norms,
                                     const std::function<bool()>& is_cancelled) {
  std::vector<EntrySample> samples;
  samples.reserve(request.entries_mm.size());
  for (const Vector3d& entry : request.entries_mm) {
    if (is_cancelled && is_cancelled()) break;
    Tunnel tunnel = request.like;
    tunnel.entry_mm = entry;
    if (request.aim_at) tunnel = request.aim_at(entry);
    const TunnelGeometry measured = measure(tunnel, bone);
    EntrySample sample{.entry_mm = entry, .verdict = Verdict::Fine};
    take(check_plan(tunnel, measured, surroundings, norms), sample);
    if (request.further && measured.enters_bone) take(request.further(tunnel, measured), sample);
    samples.push_back(std::move(sample));
  }
  return samples;
}

}  // namespace arthronaut::tunnels
