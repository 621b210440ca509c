#include "planning/tunnels/breach.h"

#include "planning/tunnels/axis_view.h"
#include "planning/tunnels/tunnel_wall.h"

namespace arthronaut::tunnels {

std::vector<DepthRange> breaches_of(const Tunnel& tunnel, const TunnelGeometry& measured,
                                    const geometry::Surface& bone) {
  if (!measured.enters_bone || measured.wall_mm >= 0) return {};
  constexpr double kBeyondSide_mm = 1;  // what lies further off is no breach
  const double rim_mm = rim_reach_mm(tunnel.diameter_mm);
  const AxisView view(bone, measured.entry_on_surface_mm, tunnel.direction, -rim_mm,
                      measured.length_mm + rim_mm, 0.5 * tunnel.diameter_mm + kBeyondSide_mm);
  return breaches(view, {.length_mm = measured.length_mm,
                         .diameter_mm = tunnel.diameter_mm,
                         .direction = tunnel.direction,
                         .entry = measured.entry,
                         .exit = measured.exit});
}

}  // namespace arthronaut::tunnels
