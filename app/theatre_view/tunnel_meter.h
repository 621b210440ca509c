// The tunnel as it was drilled, measured by what navigation saw of the guide while it was deepest.
#pragma once

#include <optional>
#include <vector>

#include "navigation/guidance/guidance.h"
#include "navigation/recording/achieved_tunnel.h"

namespace arthronaut::theatre_view {

class TunnelMeter {
 public:
  // Numbers that are not valid are ignored.
  void add(const guidance::GuidanceNumbers& guidance);
  // Nothing while the guide was never deeper than 5 mm. Else the median axis of the poses within 1 mm of the
  // greatest depth; its entry is where that axis crosses the plane through the planned entry across the plan.
  [[nodiscard]] std::optional<recording::AchievedTunnel> measured(const tunnels::Tunnel& planned) const;

 private:
  std::vector<guidance::GuidanceNumbers> deepest_;  // those that count so far
};

}  // namespace arthronaut::theatre_view
