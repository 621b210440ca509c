#include "navigation/tools/tool_set.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "planning/files/json_document.h"
#include "planning/geometry/error.h"

namespace arthronaut::tools {
namespace {

constexpr std::string_view kFormat = "arthronaut.tools";
constexpr int kVersion = 1;
constexpr int kDictionarySize = 50;  // DICT_4X4_50

// Who declared which id first, so that the message of a clash names both.
using Owners = std::map<int, std::string>;

int read_marker_id(const files::JsonObject& entry, const std::string& owner, Owners& owners) {
  const std::int64_t id = entry.integer("marker_id");
  if (id < 0 || id >= kDictionarySize) {
    entry.fail("marker_id", "must be 0 to " + std::to_string(kDictionarySize - 1) + " (DICT_4X4_50), is " +
                                std::to_string(id));
  }
  const auto [place, is_new] = owners.emplace(static_cast<int>(id), owner);
  if (!is_new) {
    entry.fail("marker_id", "marker " + std::to_string(id) + " is already declared by " + place->second);
  }
  return static_cast<int>(id);
}

ToolAxis read_axis(const files::JsonObject& entry) {
  ToolAxis axis;
  axis.point_mm = entry.vector3("axis_point_mm");
  const Eigen::Vector3d direction = entry.vector3("axis_direction");
  if (direction.norm() < 1e-6) entry.fail("axis_direction", "must not be zero");
  axis.direction = direction.normalized();
  return axis;
}

Tool read_tool(const files::JsonObject& entry, Owners& owners) {
  Tool tool;
  tool.name = entry.text("name");
  if (tool.name.empty()) entry.fail("name", "must not be empty");
  tool.marker_id = read_marker_id(entry, "tool \"" + tool.name + "\"", owners);
  tool.size_mm = entry.positive_number("size_mm");
  if (entry.has("tip_mm")) tool.tip_mm = entry.vector3("tip_mm");
  if (entry.has("axis_point_mm") || entry.has("axis_direction")) tool.axis = read_axis(entry);
  if (entry.has("residual_mm")) {
    tool.residual_mm = entry.number("residual_mm");
    if (*tool.residual_mm < 0) entry.fail("residual_mm", "must not be negative");
  }
  return tool;
}

}  // namespace

std::optional<Eigen::Vector3d> shaft_direction(const Tool& tool) {
  constexpr double kMinLength_mm = 1e-6;
  if (!tool.tip_mm || tool.tip_mm->norm() < kMinLength_mm) return std::nullopt;
  return -tool.tip_mm->normalized();
}

const Tool* ToolSet::find_tool(std::string_view name) const {
  for (const Tool& tool : tools) {
    if (tool.name == name) return &tool;
  }
  return nullptr;
}

const WorldMarker* ToolSet::find_world_marker(bones::BoneKind bone) const {
  for (const WorldMarker& marker : world_markers) {
    if (marker.bone == bone) return &marker;
  }
  return nullptr;
}

ToolSet standard_tools() {
  // A hooked probe whose plate stands across the shaft, and two aiming arms whose sleeve runs along the
  // marker's -y.
  const ToolAxis guide_axis{Eigen::Vector3d(0, -24, -3.3), -Eigen::Vector3d::UnitY()};
  ToolSet set;
  set.world_markers = {{bones::BoneKind::Femur, 0, 4.0}, {bones::BoneKind::Tibia, 1, 4.0}};
  set.tools = {{"probe", 2, 4.0, Eigen::Vector3d(0, -22.8, -13.1), std::nullopt},
               {"femoral guide", 3, 4.0, std::nullopt, guide_axis},
               {"tibial guide", 4, 4.0, std::nullopt, guide_axis}};
  return set;
}

ToolSet read_tools_file(const std::filesystem::path& file) {
  const files::JsonObject document = files::read_json(file, kFormat, kVersion);
  ToolSet set;
  Owners owners;
  for (const files::JsonObject& entry : document.objects("world_markers")) {
    WorldMarker marker;
    const std::string bone = entry.text("bone");
    try {
      marker.bone = bones::bone_kind_from_text(bone);
    } catch (const InvalidInput&) {
      entry.fail("bone", "must be \"femur\" or \"tibia\", is \"" + bone + "\"");
    }
    if (set.find_world_marker(marker.bone)) entry.fail("bone", "the " + bone + " has a world marker already");
    marker.marker_id = read_marker_id(entry, "the world marker of the " + bone, owners);
    marker.size_mm = entry.positive_number("size_mm");
    set.world_markers.push_back(marker);
  }
  for (const files::JsonObject& entry : document.objects("tools")) {
    const Tool tool = read_tool(entry, owners);
    if (set.find_tool(tool.name))
      entry.fail("name", "a tool of the name \"" + tool.name + "\" is declared already");
    set.tools.push_back(tool);
  }
  return set;
}

void write_tools_file(const std::filesystem::path& file, const ToolSet& tools) {
  nlohmann::ordered_json document;
  document["format"] = kFormat;
  document["version"] = kVersion;
  document["world_markers"] = nlohmann::ordered_json::array();
  for (const WorldMarker& marker : tools.world_markers) {
    nlohmann::ordered_json entry;
    entry["bone"] = bones::to_text(marker.bone);
    entry["marker_id"] = marker.marker_id;
    entry["size_mm"] = marker.size_mm;
    document["world_markers"].push_back(std::move(entry));
  }
  document["tools"] = nlohmann::ordered_json::array();
  for (const Tool& tool : tools.tools) {
    nlohmann::ordered_json entry;
    entry["name"] = tool.name;
    entry["marker_id"] = tool.marker_id;
    entry["size_mm"] = tool.size_mm;
    if (tool.tip_mm) entry["tip_mm"] = files::to_json(*tool.tip_mm);
    if (tool.axis) {
      entry["axis_point_mm"] = files::to_json(tool.axis->point_mm);
      entry["axis_direction"] = files::to_json(tool.axis->direction);
    }
    if (tool.residual_mm) entry["residual_mm"] = *tool.residual_mm;
    document["tools"].push_back(std::move(entry));
  }
  files::write_json(file, document);
}

}  // namespace arthronaut::tools
