#include "planning/postop/achieved_file.h"

#include <nlohmann/json.hpp>
#include <set>

#include "planning/files/json_document.h"

namespace arthronaut::postop {

namespace {

using nlohmann::ordered_json;

ordered_json number(bool is_known, double value) { return is_known ? ordered_json(value) : ordered_json(); }

ordered_json tunnel_json(const tunnels::TunnelKey& key, const AchievedTunnel& achieved) {
  const bool found = achieved.is_found;
  ordered_json json;
  json["bone"] = bones::to_text(key.bone);
  if (key.bundle != norms::Bundle::Whole) json["bundle"] = norms::to_text(key.bundle);
  json["entry_mm"] = found ? files::to_json(achieved.tunnel.entry_mm) : ordered_json();
  json["direction"] = found ? files::to_json(achieved.tunnel.direction) : ordered_json();
  json["diameter_mm"] = number(found, achieved.tunnel.diameter_mm);
  json["length_mm"] = number(found, achieved.length_mm);
  json["offset_mm"] = number(found, achieved.offset_mm);
  json["angle_deg"] = number(found, geometry::deg_from_rad(achieved.angle_rad));
  json["reliable"] = achieved.reliable;
  json["reasons"] = achieved.reasons;
  json["comes_out"] = found ? ordered_json(achieved.comes_out) : ordered_json();
  json["entry_sigma_mm"] = number(found, achieved.entry_sigma_mm);
  json["direction_sigma_deg"] = number(found, geometry::deg_from_rad(achieved.direction_sigma_rad));
  json["metal_share"] = number(found, achieved.metal_share);
  json["widths"] = ordered_json::array();
  for (const Width& width : achieved.widths)
    json["widths"].push_back({{"from_entry_mm", width.from_entry_mm}, {"diameter_mm", width.diameter_mm}});
  return json;
}

ordered_json bone_json(bones::BoneKind kind, const AchievedBone& bone) {
  ordered_json json;
  json["bone"] = bones::to_text(kind);
  json["plan_from_postop"] = bone.is_found ? files::to_json(bone.plan_from_postop) : ordered_json();
  json["rms_mm"] = number(bone.is_found, bone.rms_mm);
  json["reliable"] = bone.reliable;
  json["reasons"] = bone.reasons;
  json["on_edge_share"] = number(bone.is_found, bone.on_edge_share);
  json["in_view_share"] = number(bone.is_found, bone.in_view_share);
  return json;
}

}  // namespace

void write_achieved_file(const std::filesystem::path& file,
                         const std::map<tunnels::TunnelKey, Comparison>& comparisons) {
  ordered_json document;
  document["format"] = "arthronaut.achieved";
  document["version"] = 1;
  document["tunnels"] = ordered_json::array();
  document["bones"] = ordered_json::array();
  std::set<bones::BoneKind> told;
  for (const auto& [key, comparison] : comparisons) {
    document["tunnels"].push_back(tunnel_json(key, comparison.tunnel));
    if (told.insert(key.bone).second) document["bones"].push_back(bone_json(key.bone, comparison.bone));
  }
  files::write_json(file, document);
}

}  // namespace arthronaut::postop
