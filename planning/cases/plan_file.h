// plan.json by itself, as a part of a case and of an export. For cases case.h has what is needed.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "planning/cases/case.h"
#include "planning/files/json_document.h"

namespace arthronaut::cases {

inline constexpr std::string_view kPlanFormat = "arthronaut.plan";
// 2: some tunnel is of one bundle. A plan of single tunnels is still written as version 1.
inline constexpr int kPlanFormatVersion = 2;

// file: for what is wrong with the text. Throws InvalidInput (file, place, reason).
[[nodiscard]] Plan plan_from(const std::string& text, const std::filesystem::path& file);
// One that stands in another file of the case, as to_json() makes it.
[[nodiscard]] Plan plan_from(const files::JsonObject& node);
[[nodiscard]] nlohmann::ordered_json to_json(const Plan& plan);

// What names a plan in all that is made of it: the SHA-256 of plan.json as save_plan() writes it, so that
// `sha256sum plan.json` gives the same. Of a case's plan with_named_meshes().
[[nodiscard]] std::string plan_sha256(const Plan& plan);
// Its first 12 digits, for names and for people: "3f2a91c0b7d4".
[[nodiscard]] std::string short_plan_hash(const Plan& plan);
// "left knee, plan 3f2a91c0b7d4"; without a tunnel "left knee, nothing planned".
[[nodiscard]] std::string plan_in_words(const Case& contents);
// Where the window writes what is made of a plan: a folder for each, export/plan_3f2a91c0b7d4, so that none
// ever holds tables of one and the report of another. Without a tunnel: export.
[[nodiscard]] std::filesystem::path export_folder(const std::filesystem::path& case_folder, const Plan& plan);

// Fills in plan and plan_version, of one and the same reading. A case without plan.json has an empty plan.
// Throws IoError or InvalidInput (file, place, reason).
void read_plan(const std::filesystem::path& case_folder, Case& contents);

// The case's plan, in which every tunnel on a bone of the case names a mesh.
[[nodiscard]] Plan with_named_meshes(const Case& contents);

}  // namespace arthronaut::cases
