// What speaks against a case's plan (plan_review::verdict_of_plan), in short, for lists. Found out where the
// thumbnail is made, since the bones are read for it, and kept beside it as cache/plan_verdict.txt, which may
// be deleted at any time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/library/case_record.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::workstation_library {

[[nodiscard]] std::filesystem::path plan_verdict_file(const std::filesystem::path& case_folder);
// As Plan judges it: by what is proposed where the case's landmarks give no grid, which takes two seconds,
// else half a second a bone; without a plan what speaks against the bones, at once.
[[nodiscard]] plan_review::TunnelVerdict judge_plan(const cases::Case& knee, const cases::BoneDoubts& doubts);
// Throws IoError.
void keep_plan_verdict(const std::filesystem::path& case_folder, const plan_review::TunnelVerdict& verdict);
// nullopt: nobody has looked at the plan as it is now.
[[nodiscard]] std::optional<plan_review::TunnelVerdict> plan_verdict(
    const std::filesystem::path& case_folder);

// What speaks against bones without a plan, or that nobody can read it.
[[nodiscard]] plan_review::TunnelVerdict judge_bones(const std::filesystem::path& case_folder);

// "; wrong: femur: Wall: ... (and 2 to look at)", "; look: ..."; empty where it is fine, or null.
[[nodiscard]] std::string in_words(const plan_review::TunnelVerdict* verdict);
// "femur and tibia planned; wrong: femur: Wall: ... (and 2 to look at)", "...; look: ...", "...; not checked
// yet" where verdict is null; "no tunnel planned; look: femur: Bone: ...".
[[nodiscard]] std::string plan_in_words(const library::CaseRecord& record,
                                        const plan_review::TunnelVerdict* verdict);

// Whether a file that was made of the case is there, and not older than case, plan and what is
// doubted of the bones.
[[nodiscard]] bool is_of_now(const std::filesystem::path& made, const std::filesystem::path& case_folder);

}  // namespace arthronaut::workstation_library
