#include "navigation/operation/achieved_tunnel.h"

#include <nlohmann/json.hpp>

#include "planning/files/achieved_shape.h"
#include "planning/files/json_document.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/tunnels/tunnel_json.h"

namespace arthronaut::operation {

namespace {

constexpr std::string_view kAchievedFormat = "arthronaut.achieved";
constexpr int kAchievedVersion = 2;  // of one that was taken back; of the others 1

bool is_taken_back(const std::filesystem::path& file) {
  try {
    return read_achieved_file(file).is_taken_back;
  } catch (const std::runtime_error&) {  // as the header says
    return false;
  }
}

}  // namespace

TunnelDifference compare(const tunnels::Tunnel& reference, const tunnels::Tunnel& other) {
  const Eigen::Vector3d to_entry = reference.entry_mm - other.entry_mm;
  return {
      .entry_mm = to_entry.norm(),
      .axis_to_entry_mm = to_entry.cross(other.direction).norm(),
      .angle_deg = geometry::deg_from_rad(geometry::angle_between_rad(reference.direction, other.direction))};
}

std::string achieved_file_name(const tunnels::TunnelKey& key) {
  if (key.bundle == norms::Bundle::Whole) return "achieved.json";
  return "achieved_" + std::string(norms::to_text(key.bundle)) + ".json";
}

std::vector<std::filesystem::path> achieved_files(const std::filesystem::path& session_folder) {
  std::vector<std::filesystem::path> files;
  for (const auto bundle :
       {norms::Bundle::Whole, norms::Bundle::Anteromedial, norms::Bundle::Posterolateral}) {
    files.push_back(session_folder / achieved_file_name({bones::BoneKind::Femur, bundle}));
    if (!std::filesystem::exists(files.back()) || is_taken_back(files.back())) files.pop_back();
  }
  return files;
}

AchievedTunnel read_achieved_file(const std::filesystem::path& file) {
  const auto root = files::read_achieved(file, files::AchievedShape::OfSession);
  const tunnels::TunnelKey key = tunnels::read_key(root);
  AchievedTunnel achieved;
  achieved.planned = tunnels::read_tunnel(root.object("planned"), key);
  achieved.measured = tunnels::read_tunnel(root.object("measured"), key);
  // Nought, or hardly more, stands in older files where nobody knew it.
  constexpr double kLeastKnownDepth_mm = 1;
  if (root.has("depth_mm") && root.number("depth_mm") > kLeastKnownDepth_mm)
    achieved.depth_mm = root.number("depth_mm");
  achieved.timestamp_ns = root.integer("timestamp_ns");
  achieved.pose_count = root.int32("pose_count");
  achieved.sigma_offset_mm = root.number("sigma_offset_mm");
  achieved.sigma_angle_deg = root.number("sigma_angle_deg");
  achieved.is_taken_back = root.has("is_taken_back") && root.boolean("is_taken_back");
  if (root.has("truth")) achieved.truth = tunnels::read_tunnel(root.object("truth"), key);
  return achieved;
}

void write_achieved_file(const std::filesystem::path& file, const AchievedTunnel& achieved) {
  nlohmann::ordered_json json = {
      {"format", kAchievedFormat},
      {"version", achieved.is_taken_back ? kAchievedVersion : 1},
      {"bone", bones::to_text(achieved.planned.bone)},
      {"planned", tunnels::to_json(achieved.planned)},
      {"measured", tunnels::to_json(achieved.measured)},
      {"timestamp_ns", achieved.timestamp_ns},
      {"pose_count", achieved.pose_count},
      {"sigma_offset_mm", achieved.sigma_offset_mm},
      {"sigma_angle_deg", achieved.sigma_angle_deg},
  };
  if (achieved.planned.bundle != norms::Bundle::Whole)
    json["bundle"] = norms::to_text(achieved.planned.bundle);
  if (achieved.depth_mm) json["depth_mm"] = *achieved.depth_mm;
  if (achieved.is_taken_back) json["is_taken_back"] = true;
  if (achieved.truth) json["truth"] = tunnels::to_json(*achieved.truth);
  files::write_json(file, json);
}

}  // namespace arthronaut::operation
