#include "navigation/tools/tool_set.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "planning/bones/bone_json.h"
#include "planning/files/format.h"
#include "planning/files/json_covariance.h"
#include "planning/files/json_document.h"
#include "planning/geometry/rigid_transform.h"

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

// An arthroscope's markers have some millimetres, an outside tracker's body some centimetres. Beyond is a
// slip of the unit, and puts every pose as far off as the size.
constexpr double kSmallestMarker_mm = 0.5;
constexpr double kLargestMarker_mm = 100;
double read_size_mm(const files::JsonObject& entry) {
  const double size_mm = entry.positive_number("size_mm");
  if (size_mm < kSmallestMarker_mm || size_mm > kLargestMarker_mm)
    entry.fail("size_mm", files::format("is %g mm: the side of a marker must be %g to %g mm", size_mm,
                                        kSmallestMarker_mm, kLargestMarker_mm));
  return size_mm;
}

// One sigma that must not be negative.
std::optional<double> read_sigma(const files::JsonObject& entry, std::string_view key) {
  if (!entry.has(key)) return std::nullopt;
  const double sigma = entry.number(key);
  if (sigma < 0) entry.fail(key, "must not be negative");
  return sigma;
}

BodyMarker read_body_marker(const files::JsonObject& entry, const std::string& owner, Owners& owners) {
  BodyMarker marker;
  marker.marker_id = read_marker_id(entry, owner, owners);
  marker.size_mm = read_size_mm(entry);
  marker.body_from_marker = entry.rigid_transform("tool_from_marker");
  marker.sigma_mm = read_sigma(entry, "sigma_mm");
  marker.sigma_deg = read_sigma(entry, "sigma_deg");
  return marker;
}

// "markers", where they are several, or else "marker_id" and "size_mm".
template <typename Body>
void read_markers(const files::JsonObject& entry, const std::string& owner, Owners& owners, Body& body) {
  if (!entry.has("markers")) {
    body.marker_id = read_marker_id(entry, owner, owners);
    body.size_mm = read_size_mm(entry);
    return;
  }
  for (const char* key : {"marker_id", "size_mm"})
    if (entry.has(key)) entry.fail(key, "must not stand beside \"markers\", which say it of each");
  for (const files::JsonObject& marker : entry.objects("markers")) {
    body.markers.push_back(read_body_marker(marker, owner, owners));
    for (std::size_t i = 0; i + 1 < body.markers.size(); ++i) {
      if (lie_on_one_another(body.markers[i], body.markers.back()))
        marker.fail("tool_from_marker",
                    "lies on marker " + std::to_string(body.markers[i].marker_id) + " of the same body");
    }
  }
  if (body.markers.empty() || body.markers.size() > kMostMarkersOfBody)
    entry.fail("markers", "must be 1 to " + std::to_string(kMostMarkersOfBody) + ", are " +
                              std::to_string(body.markers.size()));
  body.marker_id = body.markers.front().marker_id;
  body.size_mm = body.markers.front().size_mm;
}

template <typename Body>
void write_markers(const Body& body, nlohmann::ordered_json& entry) {
  if (body.markers.empty()) {
    entry["marker_id"] = body.marker_id;
    entry["size_mm"] = body.size_mm;
    return;
  }
  auto markers = nlohmann::ordered_json::array();
  for (const BodyMarker& marker : body.markers) {
    nlohmann::ordered_json one;
    one["marker_id"] = marker.marker_id;
    one["size_mm"] = marker.size_mm;
    one["tool_from_marker"] = files::to_json(marker.body_from_marker);
    if (marker.sigma_mm) one["sigma_mm"] = *marker.sigma_mm;
    if (marker.sigma_deg) one["sigma_deg"] = *marker.sigma_deg;
    markers.push_back(std::move(one));
  }
  entry["markers"] = std::move(markers);
}

ToolAxis read_axis(const files::JsonObject& entry) {
  ToolAxis axis;
  axis.point_mm = entry.vector3("axis_point_mm");
  const Eigen::Vector3d direction = entry.vector3("axis_direction");
  if (direction.norm() < 1e-6) entry.fail("axis_direction", "must not be zero");
  axis.direction = direction.normalized();
  return axis;
}

// "tip_covariance_mm2", nine numbers row by row, or "tip_sigma_mm", the same in every direction.
std::optional<Eigen::Matrix3d> read_tip_covariance(const files::JsonObject& entry) {
  if (!entry.has("tip_covariance_mm2")) {
    const std::optional<double> sigma = read_sigma(entry, "tip_sigma_mm");
    if (!sigma) return std::nullopt;
    return Eigen::Matrix3d(*sigma * *sigma * Eigen::Matrix3d::Identity());
  }
  return Eigen::Matrix3d(files::read_covariance(entry, "tip_covariance_mm2", 3));
}

ToolKind read_kind(const files::JsonObject& entry) {
  if (!entry.has("kind")) return ToolKind::Any;
  if (entry.text("kind") != "drill")
    entry.fail("kind", "must be \"drill\" or absent, is \"" + entry.text("kind") + "\"");
  return ToolKind::Drill;
}

NominalParts read_nominal_parts(const files::JsonObject& entry) {
  NominalParts parts;
  for (const std::string& part : entry.texts("nominal")) {
    if (part == "tip")
      parts.tip = true;
    else if (part == "axis")
      parts.axis = true;
    else if (part == "end")
      parts.end = true;
    else
      entry.fail("nominal", "must hold \"tip\", \"axis\" or \"end\", holds \"" + part + "\"");
  }
  return parts;
}

// One sigma of each coordinate of what nobody said more of.
struct DefaultError {
  double point_sigma_mm, direction_sigma_deg;
};
DefaultError default_error(const Tool& tool, bool is_part_nominal) {
  constexpr DefaultError kMeasured{0.1, 0.2}, kNominal{0.3, 0.5};
  return tool.residual_mm && !is_part_nominal ? kMeasured : kNominal;
}

Tool read_tool(const files::JsonObject& entry, Owners& owners) {
  Tool tool;
  tool.name = entry.text("name");
  if (tool.name.empty()) entry.fail("name", "must not be empty");
  read_markers(entry, "tool \"" + tool.name + "\"", owners, tool);
  if (entry.has("tip_mm")) tool.tip_mm = entry.vector3("tip_mm");
  if (entry.has("axis_point_mm") || entry.has("axis_direction")) tool.axis = read_axis(entry);
  if (entry.has("residual_mm")) {
    tool.residual_mm = entry.number("residual_mm");
    if (*tool.residual_mm < 0) entry.fail("residual_mm", "must not be negative");
  }
  tool.kind = read_kind(entry);
  if (tool.kind == ToolKind::Drill && (!tool.tip_mm || !tool.axis))
    entry.fail("kind", "a drill needs tip_mm, axis_point_mm and axis_direction");
  tool.tip_covariance_mm2 = read_tip_covariance(entry);
  tool.axis_point_sigma_mm = read_sigma(entry, "axis_point_sigma_mm");
  tool.axis_direction_sigma_deg = read_sigma(entry, "axis_direction_sigma_deg");
  tool.provenance = provenance::read_provenance(entry, provenance::Origin::Nominal);
  if (entry.has("nominal")) tool.nominal = read_nominal_parts(entry);
  return tool;
}

OutsideTracker read_tracker(const files::JsonObject& entry, const ToolSet& set) {
  OutsideTracker tracker;
  if (entry.has("address")) tracker.address = entry.text("address");
  tracker.sigma_mm = read_sigma(entry, "sigma_mm");
  tracker.sigma_deg = read_sigma(entry, "sigma_deg");
  if (entry.has("may_repeat")) tracker.may_repeat = entry.boolean("may_repeat");
  if (!entry.has("devices")) return tracker;
  for (const files::JsonObject& device : entry.objects("devices")) {
    const std::string of = device.text("of"), name = device.text("name");
    const bool is_world =
        (of == "femur" || of == "tibia") && set.find_world_marker(bones::bone_kind_from_text(of)) != nullptr;
    if (!is_world && set.find_tool(of) == nullptr) device.fail("of", "\"" + of + "\" is not declared");
    constexpr std::size_t kLongestName = 20;  // that a message has room for
    if (name.empty() || name.size() > kLongestName) device.fail("name", "must have 1 to 20 letters");
    for (const auto& [other, taken] : tracker.devices)
      if (taken == name) device.fail("name", "\"" + name + "\" is the " + other + " already");
    if (!tracker.devices.emplace(of, name).second) device.fail("of", "\"" + of + "\" has a name already");
  }
  return tracker;
}

void write_tracker(const OutsideTracker& tracker, nlohmann::ordered_json& document) {
  nlohmann::ordered_json entry = nlohmann::ordered_json::object();
  if (!tracker.address.empty()) entry["address"] = tracker.address;
  if (tracker.sigma_mm) entry["sigma_mm"] = *tracker.sigma_mm;
  if (tracker.sigma_deg) entry["sigma_deg"] = *tracker.sigma_deg;
  if (tracker.may_repeat) entry["may_repeat"] = true;
  if (!tracker.devices.empty()) {
    entry["devices"] = nlohmann::ordered_json::array();
    for (const auto& [of, name] : tracker.devices) entry["devices"].push_back({{"of", of}, {"name", name}});
  }
  document["tracker"] = std::move(entry);
}

}  // namespace

std::vector<BodyMarker> markers_of(const Tool& tool) {
  if (!tool.markers.empty()) return tool.markers;
  return {{tool.marker_id, tool.size_mm, {}}};
}

std::vector<BodyMarker> markers_of(const WorldMarker& world) {
  if (!world.markers.empty()) return world.markers;
  return {{world.marker_id, world.size_mm, {}}};
}

geometry::RigidTransform first_marker_of(const Tool& tool) {
  return tool.markers.empty() ? geometry::RigidTransform() : tool.markers.front().body_from_marker;
}

std::optional<Eigen::Vector3d> shaft_direction(const Tool& tool) {
  constexpr double kMinLength_mm = 1e-6;
  if (!tool.tip_mm) return std::nullopt;
  const Eigen::Vector3d to_marker_mm = first_marker_of(tool).translation_mm - *tool.tip_mm;
  if (to_marker_mm.norm() < kMinLength_mm) return std::nullopt;
  return to_marker_mm.normalized();
}

bool ToolSet::has_bodies_of_several() const {
  const auto has_list = [](const auto& body) { return !body.markers.empty(); };
  return std::any_of(world_markers.begin(), world_markers.end(), has_list) ||
         std::any_of(tools.begin(), tools.end(), has_list);
}

bool ToolSet::has_several_drills() const {
  return std::count_if(tools.begin(), tools.end(),
                       [](const Tool& tool) { return tool.kind == ToolKind::Drill; }) > 1;
}

NominalParts nominal_parts(const Tool& tool) {
  if (tool.provenance.origin != provenance::Origin::Nominal) return tool.nominal;
  return {tool.tip_mm.has_value(), tool.axis.has_value(), tool.axis.has_value()};
}

Eigen::Matrix3d tip_error_mm2(const Tool& tool) {
  if (tool.tip_covariance_mm2) return *tool.tip_covariance_mm2;
  const double sigma_mm = default_error(tool, tool.nominal.tip).point_sigma_mm;
  return sigma_mm * sigma_mm * Eigen::Matrix3d::Identity();
}

AxisError axis_error(const Tool& tool) {
  const DefaultError unsaid = default_error(tool, tool.nominal.axis);
  return {tool.axis_point_sigma_mm.value_or(unsaid.point_sigma_mm),
          geometry::rad_from_deg(tool.axis_direction_sigma_deg.value_or(unsaid.direction_sigma_deg))};
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

std::string_view standard_guide_name(bones::BoneKind bone) {
  return bone == bones::BoneKind::Femur ? "femoral guide" : "tibial guide";
}

ToolSet standard_tools() {
  // A hooked probe whose plate stands across the shaft, and two aiming arms whose sleeve runs along the
  // marker's -y.
  const ToolAxis guide_axis{Eigen::Vector3d(0, -24, -3.3), -Eigen::Vector3d::UnitY()};
  ToolSet set;
  set.world_markers = {{bones::BoneKind::Femur, 0, 4.0}, {bones::BoneKind::Tibia, 1, 4.0}};
  set.tools = {{"probe", 2, 4.0, Eigen::Vector3d(0, -22.8, -13.1), std::nullopt},
               {std::string(standard_guide_name(bones::BoneKind::Femur)), 3, 4.0, std::nullopt, guide_axis},
               {std::string(standard_guide_name(bones::BoneKind::Tibia)), 4, 4.0, std::nullopt, guide_axis}};
  return set;
}

ToolSet read_tools_file(const std::filesystem::path& file) {
  const files::JsonObject document = files::read_json(file, kFormat, kVersion);
  ToolSet set;
  Owners owners;
  for (const files::JsonObject& entry : document.objects("world_markers")) {
    WorldMarker marker;
    marker.bone = bones::read_bone_kind(entry, "bone");
    const std::string bone(bones::to_text(marker.bone));
    if (set.find_world_marker(marker.bone)) entry.fail("bone", "the " + bone + " has a world marker already");
    read_markers(entry, "the world marker of the " + bone, owners, marker);
    set.world_markers.push_back(marker);
  }
  for (const files::JsonObject& entry : document.objects("tools")) {
    const Tool tool = read_tool(entry, owners);
    if (set.find_tool(tool.name))
      entry.fail("name", "a tool of the name \"" + tool.name + "\" is declared already");
    set.tools.push_back(tool);
  }
  if (document.has("tracker")) set.tracker = read_tracker(document.object("tracker"), set);
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
    write_markers(marker, entry);
    document["world_markers"].push_back(std::move(entry));
  }
  document["tools"] = nlohmann::ordered_json::array();
  for (const Tool& tool : tools.tools) {
    nlohmann::ordered_json entry;
    entry["name"] = tool.name;
    if (tool.kind == ToolKind::Drill) entry["kind"] = "drill";
    write_markers(tool, entry);
    if (tool.tip_mm) entry["tip_mm"] = files::to_json(*tool.tip_mm);
    if (tool.axis) {
      entry["axis_point_mm"] = files::to_json(tool.axis->point_mm);
      entry["axis_direction"] = files::to_json(tool.axis->direction);
    }
    if (tool.residual_mm) entry["residual_mm"] = *tool.residual_mm;
    if (tool.tip_covariance_mm2)
      entry["tip_covariance_mm2"] = files::covariance_to_json(*tool.tip_covariance_mm2);
    if (tool.axis_point_sigma_mm) entry["axis_point_sigma_mm"] = *tool.axis_point_sigma_mm;
    if (tool.axis_direction_sigma_deg) entry["axis_direction_sigma_deg"] = *tool.axis_direction_sigma_deg;
    entry["origin"] = provenance::to_text(tool.provenance.origin);
    if (!tool.provenance.calibrated_utc.empty()) entry["calibrated_utc"] = tool.provenance.calibrated_utc;
    if (tool.nominal.any()) {
      auto parts = nlohmann::ordered_json::array();
      if (tool.nominal.tip) parts.push_back("tip");
      if (tool.nominal.axis) parts.push_back("axis");
      if (tool.nominal.end) parts.push_back("end");
      entry["nominal"] = std::move(parts);
    }
    document["tools"].push_back(std::move(entry));
  }
  if (tools.tracker) write_tracker(*tools.tracker, document);
  files::write_json(file, document);
}

}  // namespace arthronaut::tools
