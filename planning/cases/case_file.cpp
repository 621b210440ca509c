// case.json and the meshes beside it.
#include <nlohmann/json.hpp>

#include "planning/bones/bone_json.h"
#include "planning/bones/mesh_file.h"
#include "planning/cases/case.h"
#include "planning/cases/case_outline.h"
#include "planning/cases/landmark_json.h"
#include "planning/cases/plan_file.h"
#include "planning/cases/study.h"
#include "planning/files/atomic_file.h"
#include "planning/files/json_document.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kCaseFormat = "arthronaut.case";
constexpr int kCaseVersion = 1;

nlohmann::ordered_json image_to_json(const CaseImage& image) {
  return {{"file", image.file},
          {"modality", image.modality},
          {"source", image.source},
          {"label_map", image.is_label_map},
          {"size", {image.size.x(), image.size.y(), image.size.z()}},
          {"spacing_mm", files::to_json(image.spacing_mm)}};
}

CaseImage image_from(const files::JsonObject& node) {
  CaseImage image;
  image.file = node.text("file");
  // A case from elsewhere must not make this program read any file of the machine.
  const fs::path named(image.file);
  if (named.parent_path() != "images" || named.filename() == ".." || named.extension() != ".nrrd")
    node.fail("file", "must be a .nrrd in the folder images");
  image.modality = node.text("modality");
  if (node.has("source")) image.source = node.text("source");
  if (node.has("label_map")) image.is_label_map = node.boolean("label_map");
  const Eigen::Vector3d size = node.vector3("size");
  if (size.minCoeff() < 1 || size.maxCoeff() > 65536) node.fail("size", "is out of range");
  image.size = size.cast<int>();
  image.spacing_mm = node.vector3("spacing_mm");
  return image;
}

// Writing a mesh takes a while; most saves change only the plan.
bool holds_mesh(const fs::path& file, const geometry::TriangleMesh& mesh) {
  if (!fs::exists(file)) return false;
  try {
    const auto there =
        bones::read_mesh(file, {.space = bones::Space::LPS, .unit = bones::LengthUnit::Millimetre});
    return there.triangles == mesh.triangles && there.vertices_mm == mesh.vertices_mm;
  } catch (const std::runtime_error&) {
    return false;  // a broken mesh is replaced
  }
}

files::JsonObject read_case_json(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw IoError(folder, "is not a case folder");
  const fs::path file = folder / "case.json";
  if (!fs::exists(file)) throw InvalidInput(folder, "", "is not a case: it holds no case.json");
  return files::read_json(file, kCaseFormat, kCaseVersion);
}

// One that is broken says nothing, and is no reason to keep a surgeon from the bones: how they lie is looked
// at besides (tunnels/knee_pose.h). Who writes it, or exports by it, is told.
bool says_two_frames(const fs::path& folder) {
  try {
    return are_of_two_frames(load_studies(folder));
  } catch (const InvalidInput&) {
    return false;
  }
}

}  // namespace

CaseOutline read_case_outline(const fs::path& case_folder) {
  const auto root = read_case_json(case_folder);
  CaseOutline outline{root.text("name"), bones::read_side(root, "side"), "", {}, {}};
  if (root.has("created_utc")) outline.created_utc = root.text("created_utc");
  for (const auto& node : root.objects("bones")) outline.bones.insert(bones::read_bone_kind(node, "kind"));
  const fs::path plan = case_folder / "plan.json";
  if (!fs::exists(plan)) return outline;
  for (const auto& [key, tunnel] : plan_from(files::read_text(plan), plan).tunnels)
    outline.planned.insert(key.bone);
  return outline;
}

Case load_case(const fs::path& folder) {
  const auto root = read_case_json(folder);
  Case result;
  result.name = root.text("name");
  result.side = bones::read_side(root, "side");
  if (root.has("created_utc")) result.created_utc = root.text("created_utc");
  for (const auto& node : root.objects("bones")) {
    bones::Bone bone;
    bone.kind = bones::read_bone_kind(node, "kind");
    if (node.has("source")) bone.source = node.text("source");
    bone.mesh = bones::read_mesh(mesh_file(folder, bone.kind),
                                 {.space = bones::Space::LPS, .unit = bones::LengthUnit::Millimetre});
    landmarks::LandmarkStates states;
    if (auto landmarks = landmarks_from(node, states); !landmarks.empty()) {
      result.landmarks[bone.kind] = std::move(landmarks);
      result.landmark_states[bone.kind] = std::move(states);
    }
    if (!result.bones.emplace(bone.kind, std::move(bone)).second) node.fail("kind", "is there twice");
  }
  if (root.has("images")) {
    for (const auto& node : root.objects("images")) result.images.push_back(image_from(node));
  }
  read_plan(folder, result);
  result.is_of_two_frames = result.bones.size() == 2 && says_two_frames(folder);
  return result;
}

std::optional<geometry::TriangleMesh> load_cartilage(const fs::path& case_folder, bones::BoneKind kind) {
  const fs::path file = cartilage_file(case_folder, kind);
  if (!fs::exists(file)) return std::nullopt;
  return bones::read_mesh(file, {.space = bones::Space::LPS, .unit = bones::LengthUnit::Millimetre});
}

void save_cartilage(const fs::path& case_folder, bones::BoneKind kind,
                    const geometry::TriangleMesh& cartilage) {
  bones::write_mesh_ply(cartilage_file(case_folder, kind), cartilage);
}

void save_landmarks(const fs::path& folder, const Case& contents) {
  auto bones = nlohmann::ordered_json::array();
  for (const auto& [kind, bone] : contents.bones) {
    nlohmann::ordered_json node = {{"kind", bones::to_text(kind)}, {"source", bone.source}};
    if (const auto marks = contents.landmarks.find(kind); marks != contents.landmarks.end()) {
      const auto states = contents.landmark_states.find(kind);
      node["landmarks"] = landmarks_to_json(marks->second, states == contents.landmark_states.end()
                                                               ? landmarks::LandmarkStates{}
                                                               : states->second);
    }
    bones.push_back(std::move(node));
  }
  nlohmann::ordered_json document = {{"format", kCaseFormat},
                                     {"version", kCaseVersion},
                                     {"name", contents.name},
                                     {"side", bones::to_text(contents.side)},
                                     {"created_utc", contents.created_utc},
                                     {"bones", std::move(bones)}};
  for (const CaseImage& image : contents.images) document["images"].push_back(image_to_json(image));
  files::write_json(folder / "case.json", document);
}

// case.json is written last: it is what makes the folder a case, and it names only meshes that are already
// there.
void save_case(const fs::path& folder, const Case& contents) {
  files::create_private_folder(folder);
  for (const auto& [kind, bone] : contents.bones)
    if (!holds_mesh(mesh_file(folder, kind), bone.mesh))
      bones::write_mesh_ply(mesh_file(folder, kind), bone.mesh);
  save_plan(folder, with_named_meshes(contents));
  save_landmarks(folder, contents);
}

}  // namespace arthronaut::cases
