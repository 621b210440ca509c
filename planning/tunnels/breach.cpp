#include "planning/tunnels/breach.h"

#include "planning/tunnels/axis_view.h"
#include "planning/tunnels/tunnel_wall.h"

namespace arthronaut::tunnels {

namespace {

AxisView view_of(const Tunnel& tunnel, const TunnelGeometry& measured, const geometry::Surface& bone,
                 double beyond_side_mm) {
  const double rim_mm = rim_reach_mm(tunnel.diameter_mm);
  return {bone,    measured.entry_on_surface_mm, tunnel.direction,
          -rim_mm, measured.length_mm + rim_mm,  0.5 * tunnel.diameter_mm + beyond_side_mm};
}

WallQuery query_of(const Tunnel& tunnel, const TunnelGeometry& measured) {
  return {.length_mm = measured.length_mm,
          .diameter_mm = tunnel.diameter_mm,
          .direction = tunnel.direction,
          .entry = measured.entry,
          .exit = measured.exit,
          .entry_steps_mm = entry_steps_mm(tunnel.bone)};
}

}  // namespace

std::vector<DepthRange> breaches_of(const Tunnel& tunnel, const TunnelGeometry& measured,
                                    const geometry::Surface& bone) {
  if (!measured.enters_bone || measured.wall_mm >= 0) return {};
  constexpr double kBeyondSide_mm = 1;  // what lies further off is no breach
  return breaches(view_of(tunnel, measured, bone, kBeyondSide_mm), query_of(tunnel, measured));
}

double stepped_mouth_to_mm(const Tunnel& tunnel, const TunnelGeometry& measured,
                           const geometry::Surface& bone) {
  if (!measured.enters_bone || entry_steps_mm(tunnel.bone) <= 0) return 0;
  constexpr double kBeyondSide_mm = 8;  // a step goes on to a face that is seen there
  return thinnest_wall(view_of(tunnel, measured, bone, kBeyondSide_mm), query_of(tunnel, measured))
      .stepped_mouth_to_mm;
}

}  // namespace arthronaut::tunnels
