#include "planning/cases/bone_doubts.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "planning/bones/bone_json.h"
#include "planning/bones/made_bone.h"
#include "planning/files/json_document.h"
#include "planning/files/remove_file.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kBoneDoubtsFormat = "arthronaut.bone_doubts";
constexpr int kBoneDoubtsVersion = 3;

SideDoubt side_doubt_from(const files::JsonObject& node) {
  const auto witness = side_witness_from_text(node.text("witness"));
  if (!witness) node.fail("witness", "is none that is known");
  return {*witness, bones::read_side(node, "told"), bones::read_side(node, "said"),
          node.has("looked_on") ? node.text("looked_on") : ""};
}

bones::ImageCut image_cut_from(const files::JsonObject& node) {
  const bones::ImageCut cut{.at_mm = node.vector3("at_mm"),
                            .out = node.vector3("out"),
                            .area_mm2 = node.positive_number("area_mm2")};
  if (!cut.is_sound()) node.fail("out", "is no unit vector");
  return cut;
}

}  // namespace

std::string words_of(const BoneDoubt& doubt) {
  if (const auto* sentence = std::get_if<std::string>(&doubt)) return *sentence;
  if (const auto* filled = std::get_if<FilledHoles>(&doubt)) return filled->words();
  if (const auto* cut = std::get_if<bones::ImageCut>(&doubt)) return cut->words();
  if (std::holds_alternative<SurfaceLookedAt>(doubt)) return "";
  return std::get<SideDoubt>(doubt).words();
}

std::vector<std::string> words_of(const std::vector<BoneDoubt>& doubts) {
  std::vector<std::string> words;
  for (const BoneDoubt& doubt : doubts)
    if (std::string of_doubt = words_of(doubt); !of_doubt.empty()) words.push_back(std::move(of_doubt));
  return words;
}

bones::UnseenParts unseen_parts_of(const BoneDoubts& doubts, const bones::Bone& bone) {
  bones::UnseenParts unseen{.was_looked_for = !bones::was_imported(bone)};
  const auto of_bone = doubts.find(bone.kind);
  if (of_bone == doubts.end()) return unseen;
  for (const BoneDoubt& doubt : of_bone->second) {
    if (const auto* cut = std::get_if<bones::ImageCut>(&doubt)) unseen.image_cuts.push_back(*cut);
    if (const auto* filled = std::get_if<FilledHoles>(&doubt))
      unseen.filled_holes.insert(unseen.filled_holes.end(), filled->holes.begin(), filled->holes.end());
    if (std::holds_alternative<SurfaceLookedAt>(doubt)) unseen.was_looked_for = true;
  }
  return unseen;
}

bool is_side_note(const BoneDoubt& doubt) {
  const auto* side = std::get_if<SideDoubt>(&doubt);
  return side != nullptr && side->is_note();
}

bool is_note(const BoneDoubt& doubt) {
  const auto* cut = std::get_if<bones::ImageCut>(&doubt);
  return is_side_note(doubt) || (cut != nullptr && !cut->is_wide()) ||
         std::holds_alternative<SurfaceLookedAt>(doubt);
}

fs::path bone_doubts_file(const fs::path& case_folder) { return case_folder / "bone_doubts.json"; }

void put_doubts(nlohmann::ordered_json& bone, const std::vector<BoneDoubt>& doubts) {
  auto sentences = nlohmann::ordered_json::array(), sides = sentences, holes = sentences, cuts = sentences;
  for (const BoneDoubt& doubt : doubts) {
    if (const auto* sentence = std::get_if<std::string>(&doubt)) sentences.push_back(*sentence);
    if (const auto* filled = std::get_if<FilledHoles>(&doubt))
      for (const bones::FilledHole& hole : filled->holes)
        holes.push_back({{"at_mm", files::to_json(hole.at_mm)}, {"across_mm", hole.across_mm}});
    if (const auto* cut = std::get_if<bones::ImageCut>(&doubt))
      cuts.push_back({{"at_mm", files::to_json(cut->at_mm)},
                      {"out", files::to_json(cut->out)},
                      {"area_mm2", cut->area_mm2}});
    const auto* side = std::get_if<SideDoubt>(&doubt);
    if (side == nullptr) continue;
    sides.push_back({{"witness", to_text(side->witness)},
                     {"told", bones::to_text(side->told)},
                     {"said", bones::to_text(side->said)}});
    if (!side->looked_on.empty()) sides.back()["looked_on"] = side->looked_on;
  }
  bone["doubts"] = std::move(sentences);
  if (std::ranges::find(doubts, BoneDoubt(SurfaceLookedAt{})) != doubts.end())
    bone["surface_looked_at"] = true;
  if (!holes.empty()) bone["filled_holes"] = std::move(holes);
  if (!cuts.empty()) bone["image_cuts"] = std::move(cuts);
  bone["side_doubts"] = std::move(sides);
}

std::vector<BoneDoubt> doubts_from(const files::JsonObject& bone) {
  const bool is_of_version_1 = !bone.has("side_doubts");
  std::vector<BoneDoubt> doubts;
  for (std::string& sentence : bone.texts("doubts")) {
    const auto side = is_of_version_1 ? side_doubt_from_words(sentence) : std::nullopt;
    doubts.push_back(side ? BoneDoubt(*side) : BoneDoubt(std::move(sentence)));
  }
  if (bone.has("filled_holes")) {
    FilledHoles filled;
    for (const files::JsonObject& hole : bone.objects("filled_holes"))
      filled.holes.push_back(
          {.at_mm = hole.vector3("at_mm"), .across_mm = hole.positive_number("across_mm")});
    if (!filled.holes.empty()) doubts.emplace_back(std::move(filled));
  }
  if (bone.has("image_cuts"))
    for (const files::JsonObject& cut : bone.objects("image_cuts")) doubts.emplace_back(image_cut_from(cut));
  if (bone.has("surface_looked_at") && bone.boolean("surface_looked_at"))
    doubts.emplace_back(SurfaceLookedAt{});
  if (is_of_version_1) return doubts;
  for (const files::JsonObject& side : bone.objects("side_doubts"))
    doubts.emplace_back(side_doubt_from(side));
  return doubts;
}

BoneDoubts load_bone_doubts(const fs::path& case_folder) {
  const fs::path file = bone_doubts_file(case_folder);
  if (!fs::exists(file)) return {};
  BoneDoubts doubts;
  for (const files::JsonObject& bone :
       files::read_json(file, kBoneDoubtsFormat, kBoneDoubtsVersion).objects("bones")) {
    const bones::BoneKind kind = bones::read_bone_kind(bone, "kind");
    if (auto of_bone = doubts_from(bone); !of_bone.empty()) doubts[kind] = std::move(of_bone);
  }
  return doubts;
}

void save_bone_doubts(const fs::path& case_folder, const BoneDoubts& doubts) {
  auto nodes = nlohmann::ordered_json::array();
  for (const auto& [kind, of_bone] : doubts) {
    if (of_bone.empty()) continue;
    nodes.push_back({{"kind", bones::to_text(kind)}});
    put_doubts(nodes.back(), of_bone);
  }
  if (nodes.empty()) return files::remove_file(bone_doubts_file(case_folder));
  files::write_json(
      bone_doubts_file(case_folder),
      {{"format", kBoneDoubtsFormat}, {"version", kBoneDoubtsVersion}, {"bones", std::move(nodes)}});
}

}  // namespace arthronaut::cases
