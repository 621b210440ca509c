// A person says of which side the case is, from the window or by a command: import/case_side.h, and what that
// means for the sessions of the case.
#pragma once

#include <filesystem>

#include "planning/import/case_side.h"

namespace arthronaut::open_case {

// As importing::say_side_of_case(), the same precondition. Refuses another side, too, where a session drilled
// a tunnel: what it reached is held against the plan that would be put aside. Says of sessions that are left
// as of which side they were recorded.
[[nodiscard]] importing::SaidSide say_side(const std::filesystem::path& case_folder, bones::Side side);

}  // namespace arthronaut::open_case
