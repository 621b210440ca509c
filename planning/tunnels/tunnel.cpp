#include "planning/tunnels/tunnel.h"

#include <algorithm>
#include <cmath>

#include "planning/tunnels/axis_view.h"
#include "planning/tunnels/tunnel_wall.h"

namespace arthronaut::tunnels {

std::string name_of(const TunnelKey& key) {
  const std::string bone(bones::to_text(key.bone));
  switch (key.bundle) {
    case norms::Bundle::Whole:
      break;
    case norms::Bundle::Anteromedial:
      return bone + " AM";
    case norms::Bundle::Posterolateral:
      return bone + " PL";
  }
  return bone;
}

namespace {

constexpr double kEntrySearchMm = 5.0;

// The mouths and the wall. Most walls are thin: what lies further off is asked for only where nothing is
// near.
void measure_sides(const Tunnel& tunnel, const geometry::Surface& bone, TunnelGeometry& result) {
  const double rim_mm = rim_reach_mm(tunnel.diameter_mm), radius_mm = 0.5 * tunnel.diameter_mm;
  const double whole_mm = geometry::bounds_of(bone.mesh()).size_mm().norm();
  bool has_mouths = false;
  for (const double reach_mm : {radius_mm + 8, radius_mm + 25, whole_mm}) {
    const AxisView view(bone, result.entry_on_surface_mm, tunnel.direction, -rim_mm,
                        result.length_mm + rim_mm, reach_mm);
    if (!has_mouths) {
      result.entry = mouth_at(view, 0, tunnel.diameter_mm, true);
      result.exit = mouth_at(view, result.length_mm, tunnel.diameter_mm, false);
      has_mouths = true;
    }
    const TunnelWall wall = thinnest_wall(view, {.length_mm = result.length_mm,
                                                 .diameter_mm = tunnel.diameter_mm,
                                                 .direction = tunnel.direction,
                                                 .entry = result.entry,
                                                 .exit = result.exit});
    result.wall_mm = whole_mm;
    result.thinnest_mm = result.exit_mm;
    result.thinnest_station_mm = result.length_mm;
    // What lies further than the view reaches is not the nearest for sure.
    if (!wall.is_known || (wall.thickness_mm + radius_mm > reach_mm && reach_mm < whole_mm)) continue;
    result.wall_mm = wall.thickness_mm;
    result.thinnest_mm = wall.at_mm;
    result.thinnest_station_mm = wall.station_mm;
    return;
  }
}

struct Passage {
  geometry::RayHit entry, exit;
};

std::optional<Passage> passage_of(const Tunnel& tunnel, const geometry::Surface& bone) {
  const auto hits = bone.all_hits(tunnel.entry_mm - kEntrySearchMm * tunnel.direction, tunnel.direction);
  // The hit into the bone that lies nearest to the planned entry, and the next one out of it.
  const auto enters = [&](const geometry::RayHit& hit) { return hit.normal.dot(tunnel.direction) < 0; };
  auto entry = hits.end();
  for (auto hit = hits.begin(); hit != hits.end(); ++hit) {
    const double off = std::abs(hit->distance_mm - kEntrySearchMm);
    if (!enters(*hit) || off > kEntrySearchMm) continue;
    if (entry == hits.end() || off < std::abs(entry->distance_mm - kEntrySearchMm)) entry = hit;
  }
  if (entry == hits.end()) return std::nullopt;
  const auto exit = std::find_if(entry + 1, hits.end(), [&](const auto& hit) { return !enters(hit); });
  if (exit == hits.end()) return std::nullopt;
  return Passage{*entry, *exit};
}

}  // namespace

Eigen::Vector3d entry_on_bone(const Tunnel& tunnel, const TunnelGeometry& measured) {
  return measured.enters_bone ? measured.entry_on_surface_mm : tunnel.entry_mm;
}

std::optional<double> length_along(const Tunnel& tunnel, const geometry::Surface& bone) {
  const auto passage = passage_of(tunnel, bone);
  if (!passage) return std::nullopt;
  return passage->exit.distance_mm - passage->entry.distance_mm;
}

TunnelGeometry measure(const Tunnel& tunnel, const geometry::Surface& bone) {
  TunnelGeometry result;
  const auto passage = passage_of(tunnel, bone);
  if (!passage) return result;
  result.enters_bone = true;
  result.entry_on_surface_mm = passage->entry.point_mm;
  result.exit_mm = passage->exit.point_mm;
  result.length_mm = passage->exit.distance_mm - passage->entry.distance_mm;
  measure_sides(tunnel, bone, result);
  return result;
}

}  // namespace arthronaut::tunnels
