#include "planning/bones/bone_json.h"

#include "planning/files/json_document.h"
#include "planning/geometry/error.h"

namespace arthronaut::bones {

BoneKind read_bone_kind(const files::JsonObject& node, std::string_view key) {
  const std::string word = node.text(key);
  try {
    return bone_kind_from_text(word);
  } catch (const InvalidInput&) {
    node.fail(key, "must be femur or tibia, is \"" + word + "\"");
  }
}

Side read_side(const files::JsonObject& node, std::string_view key) {
  const std::string word = node.text(key);
  try {
    return side_from_text(word);
  } catch (const InvalidInput&) {
    node.fail(key, "must be left or right, is \"" + word + "\"");
  }
}

}  // namespace arthronaut::bones
