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

#include "planning/bones/bone.h"
#include "planning/bones/image_cut.h"
#include "planning/bones/unseen_parts.h"
#include "planning/cases/filled_holes.h"
#include "planning/cases/side_doubt.h"

namespace arthronaut::files {
class JsonObject;
}

namespace arthronaut::cases {

// No doubt: whoever made the bone looked where its surface is none of its own, and all of it stands beside
// this. A bone without it was imported before that was looked for.
struct SurfaceLookedAt {
  bool operator==(const SurfaceLookedAt&) const = default;
};

// A sentence for a person, what is asked about the side, or where its surface is none of its own.
using BoneDoubt = std::variant<std::string, SideDoubt, FilledHoles, bones::ImageCut, SurfaceLookedAt>;
// By bone; only bones with any.
using BoneDoubts = std::map<bones::BoneKind, std::vector<BoneDoubt>>;

[[nodiscard]] std::string words_of(const BoneDoubt& doubt);  // empty: SurfaceLookedAt
[[nodiscard]] std::vector<std::string> words_of(const std::vector<BoneDoubt>& doubts);
// What speaks against nothing: SideDoubt::is_note(), a cut that is not wide, that the surface was looked at.
[[nodiscard]] bool is_note(const BoneDoubt& doubt);
[[nodiscard]] bool is_side_note(const BoneDoubt& doubt);

[[nodiscard]] std::filesystem::path bone_doubts_file(const std::filesystem::path& case_folder);
// Empty where there is no file. Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] BoneDoubts load_bone_doubts(const std::filesystem::path& case_folder);
// Atomic; without any the file goes. Throws IoError; what was there is then as before. Sentences come back
// first, what is asked about the side last.
void save_bone_doubts(const std::filesystem::path& case_folder, const BoneDoubts& doubts);

// Where nobody has seen that bone. Of one that was not imported there is nothing to look for.
[[nodiscard]] bones::UnseenParts unseen_parts_of(const BoneDoubts& doubts, const bones::Bone& bone);

// A bone's doubts in this file, and wherever else a file of the case holds some: "doubts",
// "filled_holes", "image_cuts", "surface_looked_at" and "side_doubts".
void put_doubts(nlohmann::ordered_json& bone, const std::vector<BoneDoubt>& doubts);
// Also of version 1, where all were sentences, and of 2, where no surface is known to have been looked at.
// Throws InvalidInput (file, place, reason).
[[nodiscard]] std::vector<BoneDoubt> doubts_from(const files::JsonObject& bone);

}  // namespace arthronaut::cases
