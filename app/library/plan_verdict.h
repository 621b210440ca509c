// What the checks find wrong in a case's plan, in short, for lists. Found out where the thumbnail is made,
// since the bones are read for it, and kept beside it as cache/plan_verdict.txt, which may be deleted at any
// time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planning/cases/case.h"

namespace arthronaut::workstation_library {

struct PlanVerdict {
  // "femur: Wall: 0.4 mm at 0.0 mm of depth: may break out, less than 1 mm" of each check that is wrong.
  std::vector<std::string> wrong;
};

[[nodiscard]] std::filesystem::path plan_verdict_file(const std::filesystem::path& case_folder);
// As Plan judges it: by what is proposed where the case's landmarks give no grid, which takes two seconds,
// else half a second a bone; none without a plan.
[[nodiscard]] PlanVerdict judge_plan(const cases::Case& knee);
// Throws IoError.
void keep_plan_verdict(const std::filesystem::path& case_folder, const PlanVerdict& verdict);
// nullopt: nobody has looked at the plan as it is now.
[[nodiscard]] std::optional<PlanVerdict> plan_verdict(const std::filesystem::path& case_folder);

// Whether a file that was made of the case is there, and not older than case and plan.
[[nodiscard]] bool is_of_now(const std::filesystem::path& made, const std::filesystem::path& case_folder);

}  // namespace arthronaut::workstation_library
