// What spoke against a bone when it was made of images or of a mesh (import/bone_import.h): bone_doubts.json
// in the case's folder. Whoever plans on the bone weeks later reads what the one who imported it read.
//
// A case of an older version, which kept none, has none: that nothing stands here proves nothing.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

#include "planning/bones/image_cut.h"
#include "planning/cases/filled_holes.h"
#include "planning/cases/side_doubt.h"

namespace arthronaut::files {
class JsonObject;
}

namespace arthronaut::cases {

// A sentence for a person, what is asked about the side, or where its surface is none of its own.
using BoneDoubt = std::variant<std::string, SideDoubt, FilledHoles, bones::ImageCut>;
// By bone; only bones with any.
using BoneDoubts = std::map<bones::BoneKind, std::vector<BoneDoubt>>;

[[nodiscard]] std::string words_of(const BoneDoubt& doubt);
[[nodiscard]] std::vector<std::string> words_of(const std::vector<BoneDoubt>& doubts);
// See SideDoubt::is_note().
[[nodiscard]] bool is_note(const BoneDoubt& doubt);

[[nodiscard]] std::filesystem::path bone_doubts_file(const std::filesystem::path& case_folder);
// Empty where there is no file. Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] BoneDoubts load_bone_doubts(const std::filesystem::path& case_folder);
// Atomic; without any the file goes. Throws IoError; what was there is then as before. Sentences come back
// first, what is asked about the side last.
void save_bone_doubts(const std::filesystem::path& case_folder, const BoneDoubts& doubts);

// Where the images end within that bone.
[[nodiscard]] std::vector<bones::ImageCut> image_cuts_of(const BoneDoubts& doubts, bones::BoneKind bone);

// A bone's doubts in this file, and wherever else a file of the case holds some: "doubts",
// "filled_holes", "image_cuts" and "side_doubts".
void put_doubts(nlohmann::ordered_json& bone, const std::vector<BoneDoubt>& doubts);
// Also of version 1, where all were sentences. Throws InvalidInput (file, place, reason).
[[nodiscard]] std::vector<BoneDoubt> doubts_from(const files::JsonObject& bone);

}  // namespace arthronaut::cases
