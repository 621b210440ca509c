#include "navigation/operation/achieved_tunnel.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "planning/files/achieved_shape.h"
#include "planning/files/json_document.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::operation {

namespace {

constexpr std::string_view kAchievedFormat = "arthronaut.achieved";
constexpr int kAchievedVersion = 2;  // of one that was taken back; of the others 1

nlohmann::ordered_json to_json(const tunnels::Tunnel& tunnel) {
  return {{"entry_mm", files::to_json(tunnel.entry_mm)},
          {"direction", files::to_json(tunnel.direction)},
          {"diameter_mm", tunnel.diameter_mm}};
}

tunnels::Tunnel tunnel_from(const files::JsonObject& node, const tunnels::TunnelKey& key) {
  tunnels::Tunnel tunnel;
  tunnel.bone = key.bone;
  tunnel.bundle = key.bundle;
  tunnel.entry_mm = node.vector3("entry_mm");
  tunnel.direction = node.vector3("direction");
  if (tunnel.direction.norm() < 1e-6) node.fail("direction", "must not be zero");
  // One that was written normalised comes back to the bit: what is read and written again is the same file.
  if (std::abs(tunnel.direction.squaredNorm() - 1) > 1e-12) tunnel.direction.normalize();
  tunnel.diameter_mm = node.positive_number("diameter_mm");
  return tunnel;
}

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
  tunnels::TunnelKey key = bones::bone_kind_from_text(root.text("bone"));
  if (root.has("bundle")) key.bundle = norms::bundle_from_text(root.text("bundle"));
  AchievedTunnel achieved;
  achieved.planned = tunnel_from(root.object("planned"), key);
  achieved.measured = tunnel_from(root.object("measured"), key);
  // Nought, or hardly more, stands in older files where nobody knew it.
  constexpr double kLeastKnownDepth_mm = 1;
  if (root.has("depth_mm") && root.number("depth_mm") > kLeastKnownDepth_mm)
    achieved.depth_mm = root.number("depth_mm");
  achieved.timestamp_ns = root.integer("timestamp_ns");
  achieved.pose_count = root.int32("pose_count");
  achieved.sigma_offset_mm = root.number("sigma_offset_mm");
  achieved.sigma_angle_deg = root.number("sigma_angle_deg");
  achieved.is_taken_back = root.has("is_taken_back") && root.boolean("is_taken_back");
  if (root.has("truth")) achieved.truth = tunnel_from(root.object("truth"), key);
  return achieved;
}

void write_achieved_file(const std::filesystem::path& file, const AchievedTunnel& achieved) {
  nlohmann::ordered_json json = {
      {"format", kAchievedFormat},
      {"version", achieved.is_taken_back ? kAchievedVersion : 1},
      {"bone", bones::to_text(achieved.planned.bone)},
      {"planned", to_json(achieved.planned)},
      {"measured", to_json(achieved.measured)},
      {"timestamp_ns", achieved.timestamp_ns},
      {"pose_count", achieved.pose_count},
      {"sigma_offset_mm", achieved.sigma_offset_mm},
      {"sigma_angle_deg", achieved.sigma_angle_deg},
  };
  if (achieved.planned.bundle != norms::Bundle::Whole)
    json["bundle"] = norms::to_text(achieved.planned.bundle);
  if (achieved.depth_mm) json["depth_mm"] = *achieved.depth_mm;
  if (achieved.is_taken_back) json["is_taken_back"] = true;
  if (achieved.truth) json["truth"] = to_json(*achieved.truth);
  files::write_json(file, json);
}

}  // namespace arthronaut::operation
