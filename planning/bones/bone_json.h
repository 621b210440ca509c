// Bone and side as our JSON files name them. Any other word is refused with its file and place
// (InvalidInput).
#pragma once

#include <string_view>

#include "planning/bones/bone.h"

namespace arthronaut::files {
class JsonObject;
}

namespace arthronaut::bones {

[[nodiscard]] BoneKind read_bone_kind(const files::JsonObject& node, std::string_view key);
[[nodiscard]] Side read_side(const files::JsonObject& node, std::string_view key);

}  // namespace arthronaut::bones
