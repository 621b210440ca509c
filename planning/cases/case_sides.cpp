#include "planning/cases/case_sides.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "planning/bones/bone_json.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/landmark_json.h"
#include "planning/cases/plan_file.h"
#include "planning/cases/plan_versions.h"
#include "planning/cases/step_history.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;
using bones::BoneKind;
constexpr std::string_view kSidesFormat = "arthronaut.sides";
constexpr int kSidesVersion = 3;

// By bone, the mesh that landmarks and doubts are of.
using MeshHashes = std::map<BoneKind, std::string>;

struct KeptSide {
  SideContents contents;
  MeshHashes meshes;
};

struct Sides {
  std::map<bones::Side, KeptSide> kept;
  std::optional<bones::Side> changing_to;
};

template <typename Map>
auto value_of(const Map& map, BoneKind kind) {
  const auto found = map.find(kind);
  return found == map.end() ? typename Map::mapped_type{} : found->second;
}

KeptSide kept_side_from(const files::JsonObject& node) {
  KeptSide kept;
  SideContents& contents = kept.contents;
  for (const files::JsonObject& bone : node.objects("bones")) {
    const BoneKind kind = bones::read_bone_kind(bone, "kind");
    kept.meshes[kind] = bone.text("mesh_sha256");
    landmarks::LandmarkStates states;
    if (auto marks = landmarks_from(bone, states); !marks.empty()) {
      contents.landmarks[kind] = std::move(marks);
      contents.landmark_states[kind] = std::move(states);
    }
    contents.doubts[kind] = doubts_from(bone);
  }
  contents.plan = plan_from(node.object("plan"));
  return kept;
}

Sides load_sides(const fs::path& case_folder) {
  Sides sides;
  if (!fs::exists(sides_file(case_folder))) return sides;
  const auto root = files::read_json(sides_file(case_folder), kSidesFormat, kSidesVersion);
  if (root.has("changing_to")) sides.changing_to = bones::read_side(root, "changing_to");
  for (const files::JsonObject& node : root.objects("sides"))
    sides.kept[bones::read_side(node, "side")] = kept_side_from(node);
  if (sides.changing_to && !sides.kept.contains(*sides.changing_to))
    root.fail("changing_to", "names a side of which nothing is said");
  return sides;
}

void save_sides(const fs::path& case_folder, const Sides& sides) {
  auto nodes = nlohmann::ordered_json::array();
  for (const auto& [side, kept] : sides.kept) {
    auto bones = nlohmann::ordered_json::array();
    for (const auto& [kind, mesh] : kept.meshes) {
      bones.push_back({{"kind", bones::to_text(kind)},
                       {"mesh_sha256", mesh},
                       {"landmarks", landmarks_to_json(value_of(kept.contents.landmarks, kind),
                                                       value_of(kept.contents.landmark_states, kind))}});
      put_doubts(bones.back(), value_of(kept.contents.doubts, kind));
    }
    nodes.push_back(
        {{"side", bones::to_text(side)}, {"bones", std::move(bones)}, {"plan", to_json(kept.contents.plan)}});
  }
  nlohmann::ordered_json document = {{"format", kSidesFormat}, {"version", kSidesVersion}};
  if (sides.changing_to) document["changing_to"] = bones::to_text(*sides.changing_to);
  document["sides"] = std::move(nodes);
  files::write_json(sides_file(case_folder), document);
}

MeshHashes hashes_of(const Case& contents) {
  MeshHashes hashes;
  for (const auto& [kind, bone] : contents.bones) hashes[kind] = bones::mesh_sha256(bone.mesh);
  return hashes;
}

// Whether the case holds nothing but what was put aside of its side when the change began. The plan may be
// gone: that is the change's first step.
bool is_as_it_was_left(const Case& knee, const Sides& sides) {
  const auto kept = sides.kept.find(knee.side);
  if (kept == sides.kept.end()) return knee.plan.tunnels.empty();
  const SideContents& left = kept->second.contents;
  return (knee.plan.tunnels.empty() || is_same_plan(with_named_meshes(knee), left.plan)) &&
         knee.landmarks == left.landmarks;
}

}  // namespace

fs::path sides_file(const fs::path& case_folder) { return case_folder / "sides.json"; }

std::optional<SideContents> load_side(const fs::path& case_folder, const Case& contents, bones::Side side) {
  const Sides sides = load_sides(case_folder);
  const auto found = sides.kept.find(side);
  if (found == sides.kept.end()) return std::nullopt;
  SideContents kept = found->second.contents;
  const MeshHashes now = hashes_of(contents);
  for (const auto& [kind, mesh] : found->second.meshes) {
    if (const auto there = now.find(kind); there != now.end() && there->second == mesh) continue;
    kept.landmarks.erase(kind);
    kept.landmark_states.erase(kind);
    kept.doubts.erase(kind);
  }
  return kept;
}

void change_side(const fs::path& case_folder, bones::Side side, const SideContents& contents) {
  const Case before = load_case(case_folder);
  if (before.side == side) throw InvalidInput(case_folder, "side", "is that one already");
  Sides sides = load_sides(case_folder);
  name_side_of_versions(case_folder, before.side);
  const MeshHashes meshes = hashes_of(before);
  sides.kept[before.side] = {
      {before.landmarks, before.landmark_states, with_named_meshes(before), load_bone_doubts(case_folder)},
      meshes};
  sides.kept[side] = {contents, meshes};
  sides.changing_to = side;
  save_sides(case_folder, sides);
  try {
    (void)finish_side_change(case_folder);
  } catch (const std::runtime_error&) {
    // As it was, so that nothing that is planned from here on is put aside by whoever takes the case next;
    // unless it has the new side already: then that one goes on.
    if (load_case(case_folder).side == before.side) {
      save_plan(case_folder, before.plan);
      sides.changing_to.reset();
      save_sides(case_folder, sides);
    }
    throw;
  }
}

bool finish_side_change(const fs::path& case_folder) {
  Sides sides = load_sides(case_folder);
  if (!sides.changing_to) return false;
  const bones::Side side = *sides.changing_to;
  const SideContents& contents = sides.kept.at(side).contents;
  Case knee = load_case(case_folder);
  if (knee.side != side && !is_as_it_was_left(knee, sides)) {
    // Somebody went on with the side that it has: that counts, and not a change that came to nothing.
    sides.changing_to.reset();
    save_sides(case_folder, sides);
    return false;
  }
  if (knee.side != side) {
    knee.side = side;
    knee.landmarks = contents.landmarks;
    knee.landmark_states = contents.landmark_states;
    knee.plan = {};
    save_case(case_folder, knee);  // the plan's tunnels go before the side comes
  }
  save_bone_doubts(case_folder, contents.doubts);
  save_plan(case_folder, contents.plan);
  sides.changing_to.reset();
  save_sides(case_folder, sides);
  return true;
}

}  // namespace arthronaut::cases
