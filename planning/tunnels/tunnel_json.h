// A tunnel as our JSON files have it: "bone"; "bundle" of one of two; "entry_mm", "direction", "diameter_mm".
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "planning/tunnels/tunnel.h"

namespace arthronaut::files {
class JsonObject;
}

namespace arthronaut::tunnels {

// Where it lies: all but which tunnel it is.
[[nodiscard]] nlohmann::ordered_json to_json(const Tunnel& tunnel);
// Which one it is: a single tunnel has no bundle.
void put_key(const TunnelKey& key, nlohmann::ordered_json& node);

// Both throw InvalidInput (file, place, reason): another word, a direction of no length, a diameter that is
// not above 0.
[[nodiscard]] TunnelKey read_key(const files::JsonObject& node);
// A direction that was written normalised comes back to the bit: hashes and what is written again rest on it.
[[nodiscard]] Tunnel read_tunnel(const files::JsonObject& node, const TunnelKey& key);

}  // namespace arthronaut::tunnels
