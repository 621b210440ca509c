// achieved.json, what comparisons found: format "arthronaut.achieved".
//
// Numbers of a tunnel or a bone that was not found are null; its "reliable" is false and its "reasons" say
// why. "reliable_quantities" are what may be relied on, each by itself: of a reliable tunnel all (entry,
// direction, diameter, length, and the wall where its error is known), of another those that no reason is
// about; without the key all or none. Beside what was asked for: "comes_out", "end_is_seen", "beyond_mm", one
// sigma of entry, direction, diameter and length, "widths" along the tunnel, each with its sigma, and the
// share of metal in it; of a bone how much of its surface was seen and lies on an edge. Where the place is
// given: "off_plan", the entry's way from the planned one along the bone's axes, "grid" in percent,
// "landmarks", what those are that both follow from, "wall_mm" and "planned_wall_mm". These are for other
// programs; they follow from the bone and are not read back. A tunnel of one bundle has "bundle", am or pl; a
// bone with two stands there once, as the first found it. A tunnel that was kept when newer images were
// compared has "kept_because", and in "bone_then" its bone as its own images showed it: "bones" are of the
// newer ones.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>

#include "planning/postop/achieved_place.h"
#include "planning/postop/comparison.h"

namespace arthronaut::postop {

// Atomic; "-" is standard output. Throws IoError, or InvalidInput where `file` is a comparison by a newer
// version of the program; nothing is written then.
void write_achieved_file(const std::filesystem::path& file,
                         const std::map<tunnels::TunnelKey, Comparison>& comparisons,
                         const std::map<tunnels::TunnelKey, AchievedPlace>& places = {});
// Adds the keys of a place to those of its tunnel.
void put_place(nlohmann::ordered_json& node, const AchievedPlace& place);

// What was written, back; numbers of what was not found stay as they begin. Throws IoError or InvalidInput.
[[nodiscard]] std::map<tunnels::TunnelKey, Comparison> read_achieved_file(const std::filesystem::path& file);

}  // namespace arthronaut::postop
