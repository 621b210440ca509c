// The things with markers, as solids: the screw with the world marker, the hooked probe, the drill guide.
#pragma once

#include <memory>
#include <vector>

#include "navigation/simulator/solids.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::simulator {

using Solids = std::vector<std::unique_ptr<Solid>>;

void add_world_marker(const tools::WorldMarker& marker, const geometry::RigidTransform& camera_from_marker,
                      Solids& solids);
// Both where their first marker, which the simulator takes for their frame, is seen; the others beside it.
// A probe when the tool has a tip, a drill guide when it has an axis. The plate is the first solid added.
void add_tool(const tools::Tool& tool, const geometry::RigidTransform& camera_from_marker, Solids& solids);

}  // namespace arthronaut::simulator
