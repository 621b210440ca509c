#include "app/library/plan_verdict.h"

#include <sstream>
#include <string_view>

#include "planning/files/atomic_file.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"
#include "planning/plan_review/plan_review.h"
#include "planning/plan_review/proposed_landmarks.h"

namespace arthronaut::workstation_library {

namespace fs = std::filesystem;
using plan_review::TunnelVerdict;

namespace {

// 2: by proposed landmarks where the case has none, and whether the plan is of this bone. 3: whether its
// landmarks lie where its shape puts them. 4: the side, the grid and what is to be looked at, too. 5: whether
// a tunnel leaves where the images end, and what speaks against bones without a plan.
constexpr const char* kFirstLine = "arthronaut.plan_verdict 5";
constexpr std::string_view kWrong = "wrong ", kLook = "look ";

}  // namespace

fs::path plan_verdict_file(const fs::path& case_folder) { return case_folder / "cache" / "plan_verdict.txt"; }

bool is_of_now(const fs::path& made, const fs::path& case_folder) {
  std::error_code error;
  const auto when = fs::last_write_time(made, error);
  if (error) return false;
  for (const char* file : {"case.json", "plan.json", "bone_doubts.json"}) {
    const auto written = fs::last_write_time(case_folder / file, error);
    if (!error && written > when) return false;
  }
  return true;
}

TunnelVerdict judge_plan(const cases::Case& knee, const cases::BoneDoubts& doubts) {
  if (knee.plan.tunnels.empty()) return plan_review::verdict_of_bones(doubts);
  cases::Case judged = knee;
  const auto by_shape = plan_review::propose_landmarks(judged, plan_review::Proposing::Planned);
  const plan_review::CaseReview review(judged, by_shape, doubts);
  return plan_review::verdict_of_plan(judged, plan_review::checks_of_plan(review), doubts);
}

void keep_plan_verdict(const fs::path& case_folder, const TunnelVerdict& verdict) {
  std::ostringstream text;
  text << kFirstLine << '\n';
  for (const std::string& wrong : verdict.wrong) text << kWrong << wrong << '\n';
  for (const std::string& look : verdict.look) text << kLook << look << '\n';
  files::create_private_folder(plan_verdict_file(case_folder).parent_path());
  files::write_atomically(plan_verdict_file(case_folder), text.str());
}

std::optional<TunnelVerdict> plan_verdict(const fs::path& case_folder) {
  const fs::path file = plan_verdict_file(case_folder);
  if (!is_of_now(file, case_folder)) return std::nullopt;
  try {  // a cache: what cannot be read is made again
    std::istringstream text(files::read_text(file));
    std::string line;
    if (!std::getline(text, line) || line != kFirstLine) return std::nullopt;
    TunnelVerdict verdict;
    while (std::getline(text, line)) {
      if (line.starts_with(kWrong))
        verdict.wrong.push_back(line.substr(kWrong.size()));
      else if (line.starts_with(kLook))
        verdict.look.push_back(line.substr(kLook.size()));
      else
        return std::nullopt;
    }
    return verdict;
  } catch (const IoError&) {
    return std::nullopt;
  }
}

TunnelVerdict judge_bones(const fs::path& case_folder) {
  try {  // one case that cannot be read is no reason to list none
    return plan_review::verdict_of_bones(cases::load_bone_doubts(case_folder));
  } catch (const std::runtime_error& error) {
    return {.look = {std::string("Bone: what spoke against it cannot be read: ") + error.what()}};
  }
}

std::string in_words(const TunnelVerdict* verdict) {
  if (verdict == nullptr || verdict->is_fine()) return "";
  return (verdict->is_wrong() ? "; wrong: " : "; look: ") + verdict->in_short();
}

std::string plan_in_words(const library::CaseRecord& record, const TunnelVerdict* verdict) {
  const bool is_unchecked = verdict == nullptr && !record.planned.empty();
  return record.plan_in_words() + (is_unchecked ? "; not checked yet" : in_words(verdict));
}

}  // namespace arthronaut::workstation_library
