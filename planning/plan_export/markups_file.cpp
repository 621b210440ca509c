#include "planning/plan_export/markups_file.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "planning/cases/plan_file.h"
#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/tunnels/diameter_range.h"

namespace arthronaut::plan_export {

namespace {

using Eigen::Vector3d;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* kSchema =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
    "markups-schema-v1.0.3.json#";
std::string tunnel_name(const tunnels::TunnelKey& key) { return tunnels::name_of(key) + " tunnel"; }
std::string landmarks_name(bones::BoneKind bone) { return std::string(bones::to_text(bone)) + " landmarks"; }

ordered_json control_point(int id, const std::string& label, const Vector3d& position,
                           const std::string& description) {
  return {{"id", std::to_string(id)},
          {"label", label},
          {"description", description},
          {"position", files::to_json(position)},
          {"positionStatus", "defined"},
          {"selected", true},
          {"locked", false},
          {"visibility", true}};
}

ordered_json markup(const char* type, const std::string& name, const std::string& description,
                    ordered_json points) {
  return {{"type", type},
          {"name", name},
          {"description", description},
          {"coordinateSystem", "LPS"},
          {"coordinateUnits", "mm"},
          {"locked", false},
          {"labelFormat", "%N-%d"},
          {"controlPoints", std::move(points)}};
}

// The readers of files/json_document.h ask for a format and a version, which a foreign file has not.
struct Place {
  const std::filesystem::path& file;
  std::string place;
  [[noreturn]] void fail(const std::string& reason) const { throw InvalidInput(file, place, reason); }
};

std::string text_of(const json& node, const char* key, const std::string& otherwise) {
  const auto found = node.find(key);
  return found != node.end() && found->is_string() ? found->get<std::string>() : otherwise;
}

Vector3d position_of(const json& point, double sign, const Place& place) {
  // Of such a point 3D Slicer writes the last place that it had.
  if (const std::string status = text_of(point, "positionStatus", "defined"); status != "defined")
    place.fail("is not placed: its positionStatus is \"" + status + "\"");
  const auto found = point.find("position");
  if (found == point.end() || !found->is_array() || found->size() != 3)
    place.fail("has no position of three numbers");
  Vector3d position;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(*found)[k].is_number()) place.fail("has a position that is no number");
    position[static_cast<Eigen::Index>(k)] = (*found)[k].get<double>();
  }
  if (!position.allFinite()) place.fail("has a position that is not finite");
  return {sign * position.x(), sign * position.y(), position.z()};
}

// nullopt where the description was emptied, or is another program's.
std::optional<double> diameter_of(const json& node, const Place& place) {
  const std::string text = text_of(node, "description", "");
  constexpr std::string_view kKey = "diameter_mm=";
  const auto at = text.find(kKey);
  if (at == std::string::npos) return std::nullopt;
  const double diameter = std::strtod(text.c_str() + at + kKey.size(), nullptr);
  if (!(diameter >= tunnels::kLeastDiameter_mm && diameter <= tunnels::kGreatestDiameter_mm))
    place.fail(files::format("has diameter_mm=%g, must be %g to %g", diameter, tunnels::kLeastDiameter_mm,
                             tunnels::kGreatestDiameter_mm));
  return diameter;
}

void take_tunnel(const tunnels::TunnelKey& key, const std::vector<Vector3d>& positions,
                 const std::optional<double>& diameter_mm, const Place& place, MarkupsPlan& plan) {
  if (positions.size() != 2) place.fail("must have two control points, entry and exit");
  const Vector3d along = positions[1] - positions[0];
  if (along.norm() < 1) place.fail("is shorter than 1 mm");
  for (const auto& [other, tunnel] : plan.tunnels) {
    if (other == key) place.fail("is there twice");
    if (other.bone == key.bone &&
        (other.bundle == norms::Bundle::Whole || key.bundle == norms::Bundle::Whole))
      place.fail("stands beside \"" + tunnel_name(other) +
                 "\": a bone has a single tunnel or those of bundles");
  }
  if (!diameter_mm) plan.without_diameter.insert(key);
  plan.tunnels.emplace(
      key, tunnels::Tunnel{key.bone, positions[0], along.normalized(),
                           diameter_mm.value_or(tunnels::usual_diameter_mm(key.bundle)), key.bundle});
}

void read_markup(const json& node, const Place& place, MarkupsPlan& plan) {
  if (!node.is_object()) place.fail("is no markup");
  const std::string name = text_of(node, "name", "");
  for (const auto bone : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    std::optional<tunnels::TunnelKey> key;
    for (const auto bundle :
         {norms::Bundle::Whole, norms::Bundle::Anteromedial, norms::Bundle::Posterolateral})
      if (name == tunnel_name({bone, bundle})) key = {bone, bundle};
    if (!key) continue;
    const std::string system = text_of(node, "coordinateSystem", "LPS");
    if (system != "LPS" && system != "RAS" && system != "0" && system != "1")
      place.fail("is in the coordinate system \"" + system + "\", neither LPS nor RAS");
    const double sign = system == "RAS" || system == "0" ? -1 : 1;
    if (const std::string unit = text_of(node, "coordinateUnits", "mm"); unit != "mm")
      place.fail("is in \"" + unit + "\", not in mm");
    const auto points = node.find("controlPoints");
    if (points == node.end() || !points->is_array()) place.fail("has no controlPoints");
    std::vector<Vector3d> positions;
    for (std::size_t i = 0; i < points->size(); ++i) {
      const Place here{place.file, place.place + ".controlPoints[" + std::to_string(i) + "]"};
      if (!(*points)[i].is_object()) here.fail("is no control point");
      positions.push_back(position_of((*points)[i], sign, here));
    }
    take_tunnel(*key, positions, diameter_of(node, place), place, plan);
  }
}

// "3dd6dcd6" of "diameter_mm=9.000, right knee, plan 3dd6dcd6".
std::string word_after(const std::string& text, std::string_view key) {
  const auto at = text.find(key);
  if (at == std::string::npos) return "";
  const auto from = at + key.size();
  return text.substr(from, text.find_first_of(" ,;", from) - from);
}

json parsed(const std::filesystem::path& file) {
  json root = json::parse(files::read_text(file), nullptr, false);
  if (root.is_discarded() || !root.is_object()) throw InvalidInput(file, "", "is no JSON object");
  const auto markups = root.find("markups");
  if (markups == root.end() || !markups->is_array())
    throw InvalidInput(file, "markups", "is missing: no markups of 3D Slicer");
  return root;
}

}  // namespace

std::string markups_of(const cases::Case& knee) {
  const std::string of_plan = cases::plan_in_words(knee);
  auto markups = ordered_json::array();
  for (const auto& [key, tunnel] : knee.plan.tunnels) {
    const auto bone = knee.bones.find(key.bone);
    if (bone == knee.bones.end()) continue;
    const auto measured = tunnels::measure(tunnel, geometry::Surface(bone->second.mesh));
    const Vector3d exit =
        measured.enters_bone ? measured.exit_mm : Vector3d(tunnel.entry_mm + 30 * tunnel.direction);
    markups.push_back(markup("Line", tunnel_name(key),
                             files::format("diameter_mm=%.3f, ", tunnel.diameter_mm) + of_plan,
                             {control_point(1, "entry", tunnel.entry_mm, "on the joint side"),
                              control_point(2, "exit", exit, "where the axis leaves the bone")}));
  }
  for (const auto& [kind, marks] : knee.landmarks) {
    auto points = ordered_json::array();
    const auto states = knee.landmark_states.find(kind);
    for (const auto& [name, position] : marks) {
      const auto state = states == knee.landmark_states.end() ? landmarks::LandmarkState::Confirmed
                                                              : landmarks::state_of(states->second, name);
      points.push_back(control_point(static_cast<int>(points.size()) + 1, name, position,
                                     std::string(landmarks::to_text(state))));
    }
    markups.push_back(markup("Fiducial", landmarks_name(kind), of_plan, std::move(points)));
  }
  const ordered_json root = {{"@schema", kSchema}, {"markups", std::move(markups)}};
  return root.dump(2) + "\n";
}

MarkupsPlan read_markups(const std::filesystem::path& file) {
  const json root = parsed(file);
  const json& markups = root.at("markups");
  MarkupsPlan plan;
  for (std::size_t i = 0; i < markups.size(); ++i)
    read_markup(markups[i], {file, "markups[" + std::to_string(i) + "]"}, plan);
  return plan;
}

TakenTunnels read_tunnels(const std::filesystem::path& file, const cases::Plan& planned,
                          const std::function<const geometry::Surface*(bones::BoneKind)>& surface_of) {
  MarkupsPlan plan = read_markups(file);
  std::erase_if(plan.tunnels, [&](const auto& one) { return surface_of(one.first.bone) == nullptr; });
  if (plan.tunnels.empty())
    throw InvalidInput(
        file, "markups",
        "hold no line \"femur tunnel\" or \"tibia tunnel\", nor of bundles, as \"femur AM tunnel\"");
  TakenTunnels taken;
  for (auto& [key, tunnel] : plan.tunnels) {
    if (!tunnels::measure(tunnel, *surface_of(key.bone)).enters_bone)
      throw InvalidInput(file, tunnel_name(key), "does not enter the case's bone: markups of another knee?");
    if (!plan.without_diameter.contains(key)) continue;
    const auto here = planned.tunnels.find(key);
    const bool is_planned = here != planned.tunnels.end();
    if (is_planned) tunnel.diameter_mm = here->second.diameter_mm;
    taken.note += files::format("%s%s has no diameter_mm there: %.1f mm, as %s",
                                taken.note.empty() ? "" : "; ", tunnel_name(key).c_str(), tunnel.diameter_mm,
                                is_planned ? "it was planned" : "is usual");
  }
  taken.tunnels = std::move(plan.tunnels);
  return taken;
}

std::string origin_doubt(const std::filesystem::path& file, const cases::Case& knee,
                         const std::vector<cases::PlanVersion>& kept) {
  const json root = parsed(file);
  const auto is_of = [&](const std::string& hash) {
    cases::Case other = knee;
    const auto says_it = [&] { return word_after(cases::plan_in_words(other), "plan ") == hash; };
    if (says_it()) return true;
    return std::ranges::any_of(kept, [&](const cases::PlanVersion& version) {
      other.plan = version.plan;
      return says_it();
    });
  };
  const bones::Side other_side = knee.side == bones::Side::Left ? bones::Side::Right : bones::Side::Left;
  std::string doubt;
  for (const json& node : root.at("markups")) {
    if (!node.is_object()) continue;
    const std::string said = text_of(node, "description", ""), name = text_of(node, "name", "");
    if (!name.ends_with(" tunnel")) continue;
    if (said.find(std::string(bones::to_text(other_side)) + " knee") != std::string::npos)
      throw InvalidInput(file, name,
                         "is of a " + std::string(bones::to_text(other_side)) + " knee (\"" + said +
                             "\"), and the case is a " + std::string(bones::to_text(knee.side)) + " one");
    const std::string hash = word_after(said, ", plan ");
    if (doubt.empty() && !hash.empty() && !is_of(hash))
      doubt = "the markups say that they were written of plan " + hash +
              ", which is neither the case's nor a version that it keeps: are they of this knee?";
  }
  return doubt;
}

}  // namespace arthronaut::plan_export
