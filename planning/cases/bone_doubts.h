// What spoke against a bone when it was made of images or of a mesh (import/bone_import.h): bone_doubts.json
// in the case's folder. Whoever plans on the bone weeks later reads what the one who imported it read.
//
// A case of an older version, which kept none, has none: that nothing stands here proves nothing.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "planning/bones/bone.h"

namespace arthronaut::cases {

// Sentences for a person, by bone; only bones with any.
using BoneDoubts = std::map<bones::BoneKind, std::vector<std::string>>;

[[nodiscard]] std::filesystem::path bone_doubts_file(const std::filesystem::path& case_folder);
// Empty where there is no file. Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] BoneDoubts load_bone_doubts(const std::filesystem::path& case_folder);
// Atomic; without any the file goes. Throws IoError; what was there is then as before.
void save_bone_doubts(const std::filesystem::path& case_folder, const BoneDoubts& doubts);

}  // namespace arthronaut::cases
