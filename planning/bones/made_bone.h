// Bones that the program makes itself, told by their source.
#pragma once

#include <string_view>

#include "planning/bones/bone.h"

namespace arthronaut::bones {

// What the source of one begins with.
inline constexpr std::string_view kMadeSource = "phantom knee";

// Whether the bone came from a file or a series. One without a source did not.
[[nodiscard]] inline bool was_imported(const Bone& bone) {
  return !bone.source.empty() && !bone.source.starts_with(kMadeSource);
}

}  // namespace arthronaut::bones
