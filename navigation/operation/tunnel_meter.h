// The tunnel as it was drilled, measured by what navigation saw of the guide while it stood deepest: a
// guide's end stays on the bone while the drill runs through it, so its axis is the tunnel's and its depth is
// not the drill's.
#pragma once

#include <optional>
#include <vector>

#include "navigation/guidance/guidance.h"
#include "navigation/operation/achieved_tunnel.h"

namespace arthronaut::operation {

class TunnelMeter {
 public:
  // Numbers that are not valid are ignored.
  void add(const guidance::GuidanceNumbers& guidance);
  // Whether measured() has something to say.
  [[nodiscard]] bool has_evidence() const;
  // Nothing unless the guide stood on the bone or in it (not more than 1.5 mm before the planned entry) for
  // at least 15 poses within 1 mm of its greatest depth. Else their median axis; the entry is where that axis
  // crosses the plane through the planned entry across the plan.
  [[nodiscard]] std::optional<AchievedTunnel> measured(const tunnels::Tunnel& planned) const;

 private:
  std::vector<guidance::GuidanceNumbers> deepest_;  // those that count so far
};

}  // namespace arthronaut::operation
