// A case: one knee, its bones, its plan, the theatre's files and the sessions, in a folder NAME.arthro.
//
//   case.json      format "arthronaut.case": side, bones, sources
//   plan.json      format "arthronaut.plan": tunnels
//   femur.ply      bone meshes, binary PLY, LPS, mm
//   femur_cartilage.ply         surface of what cartilage covers, where it was declared for the registration
//   camera.json, tools.json     copies of what this case is navigated with; absent until they are known
//   sessions/ID/   one folder a session (navigation/recording)
//   cache/         what can be made again from the rest; may be deleted at any time
//
// Every file is replaced atomically, so that a crash at any moment leaves the last saved state.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/landmarks/landmarks.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::cases {

struct Plan {
  std::map<bones::BoneKind, tunnels::Tunnel> tunnels;  // at most one a bone
};

struct Case {
  std::string name;
  bones::Side side = bones::Side::Right;
  std::string created_utc;  // ISO 8601
  std::map<bones::BoneKind, bones::Bone> bones;
  std::map<bones::BoneKind, landmarks::Landmarks> landmarks;
  Plan plan;
};

// Throws IoError or InvalidInput (file, place, reason): not a case, newer version, broken file, missing mesh.
[[nodiscard]] Case load_case(const std::filesystem::path& folder);

// Creates the folder where needed. Meshes are written only when they differ from what is there. Throws
// IoError.
void save_case(const std::filesystem::path& folder, const Case& contents);
// The plan alone: what changes while a surgeon plans.
void save_plan(const std::filesystem::path& folder, const Plan& plan);

[[nodiscard]] std::filesystem::path camera_file(const std::filesystem::path& case_folder);
[[nodiscard]] std::filesystem::path tools_file(const std::filesystem::path& case_folder);
[[nodiscard]] std::filesystem::path mesh_file(const std::filesystem::path& case_folder, bones::BoneKind kind);
// The bone made ready for registration.
[[nodiscard]] std::filesystem::path surface_index_file(const std::filesystem::path& case_folder,
                                                       bones::BoneKind kind);
// What cartilage covers that the bone's mesh lacks, or has too much: a surface of its own, of which the
// vertices count. A case without one declares none. load_cartilage throws as load_case, save_cartilage
// IoError.
[[nodiscard]] std::filesystem::path cartilage_file(const std::filesystem::path& case_folder,
                                                   bones::BoneKind kind);
[[nodiscard]] std::optional<geometry::TriangleMesh> load_cartilage(const std::filesystem::path& case_folder,
                                                                   bones::BoneKind kind);
void save_cartilage(const std::filesystem::path& case_folder, bones::BoneKind kind,
                    const geometry::TriangleMesh& cartilage);
// The sessions' folders, oldest first.
[[nodiscard]] std::vector<std::filesystem::path> session_folders(const std::filesystem::path& case_folder);
// Now, as created_utc wants it: "2026-01-31T12:00:00Z".
[[nodiscard]] std::string utc_now();
// A new, empty, unique session folder; its name sorts by time.
[[nodiscard]] std::filesystem::path create_session_folder(const std::filesystem::path& case_folder);

}  // namespace arthronaut::cases
