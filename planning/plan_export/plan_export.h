// The plan for other programs, in a folder: plan.json, plan.csv, the drilled bones as STL and PLY, and 3D
// Slicer's markups. Each file says of which knee's side and of which plan it is (cases::plan_sha256):
// plan.json and plan.csv in whole, the others by its first 12 digits.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "planning/cases/case.h"

namespace arthronaut::plan_export {

struct ExportSummary {
  std::vector<std::filesystem::path>
      files;  // written, in the order plan.json, plan.csv, plan.mrk.json, meshes, SHA256SUMS
  std::vector<std::string> doubts;  // a tunnel that is not of this mesh, a bone that could not be drilled
  bool was_stopped = false;         // by `stop`: nothing is written
};

// Writes plan.json, plan.csv, plan.mrk.json and, of every bone that is planned on, femur_drilled.stl and .ply
// or tibia_drilled.stl and .ply (LPS, mm); one of an earlier plan that this one does not drill is removed.
// SHA256SUMS, for sha256sum -c, holds the hash of each.
// Everything is computed before anything is written. A folder that is absent then appears with all of it in
// one step; in one that is there each file is replaced by itself, and all else stays (files::fill_folder).
// Throws InvalidInput when nothing is planned, and as refuse_foreign() does; IoError.
[[nodiscard]] ExportSummary export_plan(const cases::Case& knee, const std::filesystem::path& folder,
                                        const std::stop_token& stop = {});

// An earlier export is written over, nothing else. Throws InvalidInput, which names the file, where one of
// these names is another program's: one that is not as SHA256SUMS has it, such as landmarks or tunnels that
// were moved in 3D Slicer, which somebody may still want to read back; where that file is not there, a
// plan.json that is no plan, a plan.csv of other columns, and a plan.mrk.json with other tunnels.
void refuse_foreign(const std::filesystem::path& folder);

// One row a tunnel, header first: bone, entry, direction, diameter, exit, length, wall (empty where the
// tunnel misses), bundle (single, am, pl), side, plan_sha256.
[[nodiscard]] std::string plan_csv(const cases::Case& knee);

}  // namespace arthronaut::plan_export
