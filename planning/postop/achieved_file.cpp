#include "planning/postop/achieved_file.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "planning/bones/bone_json.h"
#include "planning/files/achieved_shape.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "planning/tunnels/tunnel_json.h"

namespace arthronaut::postop {

namespace {

using nlohmann::ordered_json;

// What is not finite is not known.
ordered_json number(bool is_known, double value) {
  return is_known && std::isfinite(value) ? ordered_json(value) : ordered_json();
}

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
  json["reliable_quantities"] = ordered_json::array();
  for (const tunnels::Quantity quantity : achieved.reliable ? tunnels::all_quantities() : achieved.known)
    json["reliable_quantities"].push_back(tunnels::to_text(quantity));
  json["comes_out"] = found ? ordered_json(achieved.comes_out) : ordered_json();
  json["end_is_seen"] = found ? ordered_json(achieved.end_is_seen) : ordered_json();
  json["beyond_mm"] = found ? ordered_json(achieved.beyond_mm) : ordered_json();
  json["entry_sigma_mm"] = number(found, achieved.entry_sigma_mm);
  json["direction_sigma_deg"] = number(found, geometry::deg_from_rad(achieved.direction_sigma_rad));
  json["diameter_sigma_mm"] = number(found, achieved.diameter_sigma_mm);
  json["length_sigma_mm"] = number(found, achieved.length_sigma_mm);
  json["metal_share"] = number(found, achieved.metal_share);
  json["offset_across_mm"] = number(found, achieved.offset_across_mm);
  json["widths"] = ordered_json::array();
  for (const Width& width : achieved.widths)
    json["widths"].push_back({{"from_entry_mm", width.from_entry_mm},
                              {"diameter_mm", width.diameter_mm},
                              {"sigma_mm", number(true, width.sigma_mm)}});
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

// Where two tunnels were found in the same bone: as the images that were compared last show it.
std::map<bones::BoneKind, const AchievedBone*> bones_of(
    const std::map<tunnels::TunnelKey, Comparison>& comparisons) {
  std::map<bones::BoneKind, const AchievedBone*> newest;
  for (const bool is_kept : {false, true})
    for (const auto& [key, comparison] : comparisons)
      if (comparison.kept_because.empty() != is_kept) newest.emplace(key.bone, &comparison.bone);
  return newest;
}

AchievedBone bone_of(const files::JsonObject& node) {
  AchievedBone bone;
  bone.reliable = node.boolean("reliable");
  bone.reasons = node.texts("reasons");
  bone.is_found = node.has("plan_from_postop");
  if (!bone.is_found) return bone;
  bone.plan_from_postop = node.rigid_transform("plan_from_postop");
  bone.rms_mm = node.number("rms_mm");
  if (node.has("on_edge_share")) bone.on_edge_share = node.number("on_edge_share");
  if (node.has("in_view_share")) bone.in_view_share = node.number("in_view_share");
  return bone;
}

AchievedTunnel tunnel_of(const files::JsonObject& node, const tunnels::TunnelKey& key) {
  AchievedTunnel achieved;
  achieved.tunnel.bone = key.bone;
  achieved.tunnel.bundle = key.bundle;
  achieved.reliable = node.boolean("reliable");
  achieved.reasons = node.texts("reasons");
  achieved.is_found = node.has("entry_mm");
  if (!achieved.is_found) return achieved;
  if (!achieved.reliable && node.has("reliable_quantities"))
    for (const std::string& name : node.texts("reliable_quantities"))
      if (const auto quantity = tunnels::quantity_from_text(name)) achieved.known.insert(*quantity);
  achieved.tunnel = tunnels::read_tunnel(node, key);
  achieved.length_mm = node.number("length_mm");
  achieved.offset_mm = node.number("offset_mm");
  achieved.angle_rad = geometry::rad_from_deg(node.number("angle_deg"));
  if (node.has("offset_across_mm")) achieved.offset_across_mm = node.number("offset_across_mm");
  if (node.has("comes_out")) achieved.comes_out = node.boolean("comes_out");
  if (node.has("end_is_seen")) achieved.end_is_seen = node.boolean("end_is_seen");
  if (node.has("beyond_mm")) achieved.beyond_mm = node.number("beyond_mm");
  if (node.has("entry_sigma_mm")) achieved.entry_sigma_mm = node.number("entry_sigma_mm");
  if (node.has("direction_sigma_deg"))
    achieved.direction_sigma_rad = geometry::rad_from_deg(node.number("direction_sigma_deg"));
  if (node.has("diameter_sigma_mm")) achieved.diameter_sigma_mm = node.number("diameter_sigma_mm");
  if (node.has("length_sigma_mm")) achieved.length_sigma_mm = node.number("length_sigma_mm");
  if (node.has("metal_share")) achieved.metal_share = node.number("metal_share");
  if (!node.has("widths")) return achieved;
  for (const files::JsonObject& node_of_width : node.objects("widths")) {
    Width width{.from_entry_mm = node_of_width.number("from_entry_mm"),
                .diameter_mm = node_of_width.number("diameter_mm")};
    if (node_of_width.has("sigma_mm")) width.sigma_mm = node_of_width.positive_number("sigma_mm");
    achieved.widths.push_back(width);
  }
  return achieved;
}

}  // namespace

std::map<tunnels::TunnelKey, Comparison> read_achieved_file(const std::filesystem::path& file) {
  const files::JsonObject document = files::read_achieved(file, files::AchievedShape::OfComparison);
  std::map<bones::BoneKind, AchievedBone> found;
  for (const files::JsonObject& node : document.objects("bones"))
    found[bones::read_bone_kind(node, "bone")] = bone_of(node);
  std::map<tunnels::TunnelKey, Comparison> comparisons;
  for (const files::JsonObject& node : document.objects("tunnels")) {
    const tunnels::TunnelKey key = tunnels::read_key(node);
    Comparison& comparison = comparisons[key];
    comparison.tunnel = tunnel_of(node, key);
    if (node.has("kept_because")) comparison.kept_because = node.text("kept_because");
    if (node.has("bone_then"))
      comparison.bone = bone_of(node.object("bone_then"));
    else if (const auto bone = found.find(key.bone); bone != found.end())
      comparison.bone = bone->second;
  }
  return comparisons;
}

void put_place(ordered_json& node, const AchievedPlace& place) {
  node["off_plan"] = {{"anterior_mm", place.off_mm.x()},
                      {"proximal_mm", place.off_mm.y()},
                      {"lateral_mm", place.off_mm.z()},
                      {"axes_from", landmarks::to_text(place.axes_from)}};
  node["grid"] = ordered_json::array();
  for (const AchievedPlace::Share& share : place.grid)
    node["grid"].push_back({{"name", share.name},
                            {"planned_percent", share.planned_percent},
                            {"achieved_percent", share.achieved_percent}});
  const bool by_landmarks =
      !place.grid.empty() || place.axes_from == landmarks::AnatomicalAxes::Origin::FromLandmarks;
  node["landmarks"] = by_landmarks ? ordered_json(landmarks::to_text(place.landmarks_are)) : ordered_json();
  node["wall_mm"] = number(place.wall_mm.has_value(), place.wall_mm.value_or(0));
  node["wall_sigma_mm"] = number(place.wall_mm.has_value(), place.wall_sigma_mm);
  node["planned_wall_mm"] = number(place.planned_wall_mm.has_value(), place.planned_wall_mm.value_or(0));
}

namespace {

constexpr int kVersion = 1;

// What a newer program found may be what this one cannot find.
void refuse_to_replace_a_newer(const std::filesystem::path& file) {
  if (file == "-" || !std::filesystem::is_regular_file(file)) return;
  std::int64_t version = 0;
  try {
    version = files::read_json(file, "arthronaut.achieved", std::numeric_limits<int>::max()).version();
  } catch (const InvalidInput&) {  // broken: it tells nobody anything
  }
  if (version > kVersion)
    throw InvalidInput(file, "version",
                       "is " + std::to_string(version) + ", newer than this program writes (" +
                           std::to_string(kVersion) + "); it stays as it is");
}

}  // namespace

void write_achieved_file(const std::filesystem::path& file,
                         const std::map<tunnels::TunnelKey, Comparison>& comparisons,
                         const std::map<tunnels::TunnelKey, AchievedPlace>& places) {
  refuse_to_replace_a_newer(file);
  ordered_json document;
  document["format"] = "arthronaut.achieved";
  document["version"] = kVersion;
  document["tunnels"] = ordered_json::array();
  document["bones"] = ordered_json::array();
  for (const auto& [key, comparison] : comparisons) {
    document["tunnels"].push_back(tunnel_json(key, comparison.tunnel));
    if (const auto place = places.find(key); place != places.end()) {
      put_place(document["tunnels"].back(), place->second);
      if (comparison.tunnel.reliable && is_wall_known(place->second))
        document["tunnels"].back()["reliable_quantities"].push_back("wall");
    }
    if (comparison.kept_because.empty()) continue;
    document["tunnels"].back()["kept_because"] = comparison.kept_because;
    document["tunnels"].back()["bone_then"] = bone_json(key.bone, comparison.bone);
  }
  for (const auto& [kind, bone] : bones_of(comparisons)) document["bones"].push_back(bone_json(kind, *bone));
  files::write_json(file, document);
}

}  // namespace arthronaut::postop
