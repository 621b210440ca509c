// A person says of which side a case is that is there: because it was imported as of the other one, or
// because what its bones were made from speaks against it, and he has looked.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planning/bones/bone.h"

namespace arthronaut::importing {

struct SaidSide {
  bool is_changed = false;
  std::vector<std::string> lines;  // what came of it, sentences for a person
};

// Of the side that the case has: the doubts that ask for its side to be checked say from then on that
// somebody did. Of the other one: the case becomes a knee of that side (cases/case_sides.h). Landmarks and
// plan of the side that it had are put aside, and are back when it is said again; the landmarks of the other
// side are proposed anew when they are next asked for. Doubts that spoke for the side that is said now are
// gone; where none did, that stands as a doubt. Bones, images, cartilage and measurements stay; so do
// registrations, which are of the bone's surface.
//
// Precondition: the caller has the case's lock. Throws InvalidInput: what a CT after the operation showed is
// held against the plan that would be put aside; nothing was written. Throws else as cases::change_side().
[[nodiscard]] SaidSide say_side_of_case(const std::filesystem::path& case_folder, bones::Side side);

}  // namespace arthronaut::importing
