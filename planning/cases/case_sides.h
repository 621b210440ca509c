// Another side for a case that is there. Landmarks, plan and doubts of a left knee are none of a right one:
// they are put aside in sides.json of the case's folder, and are back when the case is of that side again.
//
// Several files change. sides.json is written first, with all that is to be and the side that is gone to;
// then plan.json loses its tunnels, case.json gets side and landmarks, and doubts and plan follow. A crash in
// between leaves a case of either side without a plan of the other one, and whoever takes the case next
// (CaseLock) goes on where it stopped.
//
// What becomes of the doubts, and what stands against a change, import/case_side.h says.
#pragma once

#include <filesystem>
#include <optional>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"

namespace arthronaut::cases {

// What a case holds that is of one side.
struct SideContents {
  std::map<bones::BoneKind, landmarks::Landmarks> landmarks = {};
  std::map<bones::BoneKind, landmarks::LandmarkStates> landmark_states = {};
  Plan plan = {};
  BoneDoubts doubts =
      {};  // as load_side() gives them, an entry for each bone that they are of, if an empty one
};

[[nodiscard]] std::filesystem::path sides_file(const std::filesystem::path& case_folder);
// What was put aside of that side; nullopt: the case was never said to be of it. Landmarks and doubts of a
// bone that has another mesh by now are left out; a tunnel names the mesh that it is of. Throws IoError or
// InvalidInput (file, place, reason).
[[nodiscard]] std::optional<SideContents> load_side(const std::filesystem::path& case_folder,
                                                    const Case& contents, bones::Side side);
// The case becomes one of that side, which it is not, with these contents; what it has now is put aside.
// Precondition: the caller has the case's lock. Throws IoError or InvalidInput: before anything but
// sides.json was written the case is as before; afterwards finish_side_change() goes on.
void change_side(const std::filesystem::path& case_folder, bones::Side side, const SideContents& contents);
// A change that was cut off goes on to its end; whether there was one. Throws as change_side().
bool finish_side_change(const std::filesystem::path& case_folder);

}  // namespace arthronaut::cases
