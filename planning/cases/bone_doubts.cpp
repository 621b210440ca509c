#include "planning/cases/bone_doubts.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "planning/files/json_document.h"
#include "planning/files/remove_file.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kBoneDoubtsFormat = "arthronaut.bone_doubts";
constexpr int kBoneDoubtsVersion = 1;

}  // namespace

fs::path bone_doubts_file(const fs::path& case_folder) { return case_folder / "bone_doubts.json"; }

BoneDoubts load_bone_doubts(const fs::path& case_folder) {
  const fs::path file = bone_doubts_file(case_folder);
  if (!fs::exists(file)) return {};
  BoneDoubts doubts;
  for (const files::JsonObject& bone :
       files::read_json(file, kBoneDoubtsFormat, kBoneDoubtsVersion).objects("bones")) {
    const std::string kind = bone.text("kind");
    if (kind != "femur" && kind != "tibia") bone.fail("kind", "must be femur or tibia");
    if (auto texts = bone.texts("doubts"); !texts.empty())
      doubts[bones::bone_kind_from_text(kind)] = std::move(texts);
  }
  return doubts;
}

void save_bone_doubts(const fs::path& case_folder, const BoneDoubts& doubts) {
  auto nodes = nlohmann::ordered_json::array();
  for (const auto& [kind, texts] : doubts)
    if (!texts.empty()) nodes.push_back({{"kind", bones::to_text(kind)}, {"doubts", texts}});
  if (nodes.empty()) return files::remove_file(bone_doubts_file(case_folder));
  files::write_json(
      bone_doubts_file(case_folder),
      {{"format", kBoneDoubtsFormat}, {"version", kBoneDoubtsVersion}, {"bones", std::move(nodes)}});
}

}  // namespace arthronaut::cases
