#include "planning/tunnels/tunnel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arthronaut::tunnels {

namespace {

constexpr double kEntrySearchMm = 5.0;
constexpr double kWallStepMm = 0.5;

// Bone beside the tunnel. Within a diameter of either mouth the nearest surface is the mouth itself: those
// stretches are left out, and of a very short tunnel only the middle is looked at.
double least_wall_mm(const Tunnel& tunnel, const Eigen::Vector3d& entry_mm, double length_mm,
                     const geometry::Surface& bone) {
  const double margin = std::min(tunnel.diameter_mm, 0.5 * length_mm);
  double least = std::numeric_limits<double>::infinity();
  for (double s = margin; s <= length_mm - margin + 1e-9; s += kWallStepMm) {
    const Eigen::Vector3d axis_point = entry_mm + s * tunnel.direction;
    const double to_surface = (bone.closest_point(axis_point).point_mm - axis_point).norm();
    least = std::min(least, to_surface - 0.5 * tunnel.diameter_mm);
  }
  return least;
}

}  // namespace

TunnelGeometry measure(const Tunnel& tunnel, const geometry::Surface& bone) {
  TunnelGeometry result;
  const auto hits = bone.all_hits(tunnel.entry_mm - kEntrySearchMm * tunnel.direction, tunnel.direction);
  // The hit into the bone that lies nearest to the planned entry, and the next one out of it.
  const auto enters = [&](const geometry::RayHit& hit) { return hit.normal.dot(tunnel.direction) < 0; };
  auto entry = hits.end();
  for (auto hit = hits.begin(); hit != hits.end(); ++hit) {
    const double off = std::abs(hit->distance_mm - kEntrySearchMm);
    if (!enters(*hit) || off > kEntrySearchMm) continue;
    if (entry == hits.end() || off < std::abs(entry->distance_mm - kEntrySearchMm)) entry = hit;
  }
  if (entry == hits.end()) return result;
  const auto exit = std::find_if(entry + 1, hits.end(), [&](const auto& hit) { return !enters(hit); });
  if (exit == hits.end()) return result;
  result.enters_bone = true;
  result.entry_on_surface_mm = entry->point_mm;
  result.exit_mm = exit->point_mm;
  result.length_mm = exit->distance_mm - entry->distance_mm;
  result.wall_mm = least_wall_mm(tunnel, entry->point_mm, result.length_mm, bone);
  return result;
}

}  // namespace arthronaut::tunnels
