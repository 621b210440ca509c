// What a case says of itself, without its meshes and its images: for lists of many cases.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "planning/bones/bone.h"

namespace arthronaut::cases {

struct CaseOutline {
  std::string name;
  bones::Side side = bones::Side::Right;
  std::string created_utc;  // ISO 8601; empty in older cases
  std::set<bones::BoneKind> bones;
  std::set<bones::BoneKind> planned;  // which of them, or of others, the plan has a tunnel for
};

// Reads case.json and plan.json alone. Throws IoError or InvalidInput (file, place, reason) as load_case()
// does for these two; whether the meshes are there and whole is not looked at.
[[nodiscard]] CaseOutline read_case_outline(const std::filesystem::path& case_folder);

}  // namespace arthronaut::cases
