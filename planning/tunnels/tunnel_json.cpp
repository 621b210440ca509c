#include "planning/tunnels/tunnel_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "planning/bones/bone_json.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"

namespace arthronaut::tunnels {

namespace {

norms::Bundle read_bundle(const files::JsonObject& node) {
  if (!node.has("bundle")) return norms::Bundle::Whole;
  const std::string word = node.text("bundle");
  try {
    return norms::bundle_from_text(word);
  } catch (const InvalidInput&) {
    node.fail("bundle", "must be single, am or pl, is \"" + word + "\"");
  }
}

}  // namespace

nlohmann::ordered_json to_json(const Tunnel& tunnel) {
  return {{"entry_mm", files::to_json(tunnel.entry_mm)},
          {"direction", files::to_json(tunnel.direction)},
          {"diameter_mm", tunnel.diameter_mm}};
}

void put_key(const TunnelKey& key, nlohmann::ordered_json& node) {
  node["bone"] = bones::to_text(key.bone);
  if (key.bundle != norms::Bundle::Whole) node["bundle"] = norms::to_text(key.bundle);
}

TunnelKey read_key(const files::JsonObject& node) {
  return {bones::read_bone_kind(node, "bone"), read_bundle(node)};
}

Tunnel read_tunnel(const files::JsonObject& node, const TunnelKey& key) {
  Tunnel tunnel;
  tunnel.bone = key.bone;
  tunnel.bundle = key.bundle;
  tunnel.entry_mm = node.vector3("entry_mm");
  tunnel.direction = node.vector3("direction");
  if (tunnel.direction.norm() < 1e-6) node.fail("direction", "must not be zero");
  if (std::abs(tunnel.direction.squaredNorm() - 1) > 1e-12) tunnel.direction.normalize();
  tunnel.diameter_mm = node.positive_number("diameter_mm");
  return tunnel;
}

}  // namespace arthronaut::tunnels
