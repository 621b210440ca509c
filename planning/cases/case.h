// A case: one knee, its bones, its plan, the theatre's files and the sessions, in a folder NAME.arthro.
//
//   case.json, plan.json       side, bones, sources; tunnels, each with its mesh; plan_versions/N.json kept
//   identity.json, study.json  whose knee it is (identity.h) and of which study (study.h): nowhere else
//   note.json, case.lock       what somebody noted (case_note.h), who works on it now (case_lock.h)
//   femur.ply, femur_cartilage.ply   bones, LPS, mm; what cartilage covers, where it was declared
//   images/1.nrrd, painting/, bone_doubts.json  what the bones were made from, and what spoke against them
//   sides.json                 what was put aside when it was said to be of the other side (case_sides.h)
//   history.json               what was done to the plan, to be taken back (step_history.h)
//   measurements.json          taken in the images; achieved.json what a CT after the operation showed
//   camera.json, tools.json, fluid.json   what it is navigated with; the newest check in fluid
//   sessions/ID/               one folder a session, exercises too (navigation/recording)
//   pictures/, report.pdf      of the operation, sent as DICOM; of the demo. Videos lie there too
//   screens/, export/          pictures of the screen (app/screen_copy); the plan for other programs
//   cache/                     what can be made again from the rest; may be deleted at any time
//
// Every file is replaced atomically: a crash at any moment leaves each as it was last saved, and of a whole
// case that was being saved some already new. The folder is its owner's alone: folders 0700, files 0600
// (files/private_folder.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/cases/case_image.h"
#include "planning/landmarks/landmarks.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::cases {

struct Plan {
  // Of a bone its single tunnel, or one or two of bundles, never both kinds: put() keeps it so.
  std::map<tunnels::TunnelKey, tunnels::Tunnel> tunnels;
  // bones::mesh_sha256 of the mesh that the tunnel was planned on. A tunnel of an older file names none.
  std::map<tunnels::TunnelKey, std::string> mesh_sha256 = {};

  // The bone's tunnels; none, one or two.
  [[nodiscard]] std::vector<tunnels::TunnelKey> of(bones::BoneKind bone) const;
  // In place of the one with its key. A single one takes the place of both bundles', one of a bundle that of
  // a single one. An empty hash: nobody knows on which mesh it was planned.
  void put(const tunnels::Tunnel& tunnel, const std::string& planned_on_mesh_sha256);
  void remove(const tunnels::TunnelKey& key);
};

struct Case {
  std::string name;
  bones::Side side = bones::Side::Right;
  std::string created_utc;  // ISO 8601
  std::map<bones::BoneKind, bones::Bone> bones;
  std::map<bones::BoneKind, landmarks::Landmarks> landmarks;
  Plan plan;
  std::vector<CaseImage> images = {};  // oldest first; empty for a case of meshes, and of older versions
  std::string plan_version = {};       // see plan_version(); of the moment when the case was loaded
  // Which landmarks are proposals; one that is not in it is confirmed (landmarks/landmarks.h).
  std::map<bones::BoneKind, landmarks::LandmarkStates> landmark_states = {};
  // Femur and tibia were made in images of two frames of reference (study.h), of the moment when the case was
  // loaded: where the one lies says nothing of where the other does.
  bool is_of_two_frames = false;
};

// Throws IoError or InvalidInput (file, place, reason): not a case, newer version, broken file, missing mesh.
[[nodiscard]] Case load_case(const std::filesystem::path& folder);

// Creates the folder where needed and makes it private. Meshes are written only when they differ from what is
// there, and before case.json: landmarks of a mesh that another one replaces are to be gone from the disk by
// then (import/case_import.h). A tunnel that names no mesh is saved with the name of the case's. Throws
// IoError.
void save_case(const std::filesystem::path& folder, const Case& contents);
// case.json alone, of a case that is there: before a plan that its landmarks' grid was the ruler of. Throws
// IoError; what was there is then as before.
void save_landmarks(const std::filesystem::path& folder, const Case& contents);
// The plan alone: what changes while a surgeon plans. Replaces what is there, whatever it is.
void save_plan(const std::filesystem::path& folder, const Plan& plan);

// Which plan is on disk: a hash of plan.json, empty when there is none.
[[nodiscard]] std::string plan_version(const std::filesystem::path& folder);
// Saves the plan over the version that it was made from, and returns the new version. Throws InvalidInput
// when another program has changed plan.json since; nothing is then written. Throws IoError.
[[nodiscard]] std::string save_plan_over(const std::filesystem::path& folder, const Plan& plan,
                                         const std::string& version);

// Whether a tunnel was planned on the mesh that the case holds.
struct PlanFit {
  enum class Outcome {
    NoPlan,
    Fits,
    Unknown,    // an older file, which does not say; taken as fitting
    OtherMesh,  // must not be navigated by
    NoBone,     // planned on a bone that the case lacks
  } outcome = Outcome::NoPlan;
  std::string reason = "no tunnel is planned";  // why the plan is not valid; empty when it is
  [[nodiscard]] bool is_valid() const { return outcome == Outcome::Fits || outcome == Outcome::Unknown; }
};
// mesh_sha256: of the case's mesh of that bone, empty when it has none. For those who keep it at hand.
[[nodiscard]] PlanFit plan_fit(const Plan& plan, const tunnels::TunnelKey& key,
                               const std::string& mesh_sha256);
// Computes the hash of the mesh: milliseconds.
[[nodiscard]] PlanFit plan_fit(const Case& contents, const tunnels::TunnelKey& key);
// Whether plan_fit() is valid: what is guided by must be.
[[nodiscard]] bool plan_fits(const Case& contents, const tunnels::TunnelKey& key);
// Gives the tunnels that name no mesh the name of the case's.
void name_meshes(Case& contents);

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

// A session's folder is named by its number in the case, then by the clock, for people: 0007-20260131-120000.
// The number, not the clock, tells which is newer: a clock may be set back. Folders of older versions have no
// number (20260131-120000); they are older than all that have one.
//
// The number; 0 without one.
[[nodiscard]] std::int64_t session_number(const std::filesystem::path& session_folder);
// The sessions' folders, oldest first.
[[nodiscard]] std::vector<std::filesystem::path> session_folders(const std::filesystem::path& case_folder);
// A new, empty folder with a number one above the largest, also when other processes make theirs at the same
// time. Throws IoError.
[[nodiscard]] std::filesystem::path create_session_folder(const std::filesystem::path& case_folder);

}  // namespace arthronaut::cases
