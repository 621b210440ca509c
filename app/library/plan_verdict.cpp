#include "app/library/plan_verdict.h"

#include <sstream>

#include "planning/files/atomic_file.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"
#include "planning/plan_review/landmark_check.h"
#include "planning/plan_review/plan_review.h"
#include "planning/plan_review/proposed_landmarks.h"

namespace arthronaut::workstation_library {

namespace fs = std::filesystem;

namespace {

// 2: by proposed landmarks where the case has none, and whether the plan is of this bone. 3: whether its
// landmarks lie where its shape puts them.
constexpr const char* kFirstLine = "arthronaut.plan_verdict 3";

}  // namespace

fs::path plan_verdict_file(const fs::path& case_folder) { return case_folder / "cache" / "plan_verdict.txt"; }

bool is_of_now(const fs::path& made, const fs::path& case_folder) {
  std::error_code error;
  const auto when = fs::last_write_time(made, error);
  if (error) return false;
  for (const char* file : {"case.json", "plan.json"}) {
    const auto written = fs::last_write_time(case_folder / file, error);
    if (!error && written > when) return false;
  }
  return true;
}

PlanVerdict judge_plan(const cases::Case& knee) {
  PlanVerdict verdict;
  if (knee.plan.tunnels.empty()) return verdict;
  cases::Case judged = knee;
  const auto by_shape = plan_review::propose_landmarks(judged, plan_review::Proposing::Planned);
  const plan_review::CaseReview review(judged, by_shape);
  for (const auto& [key, tunnel] : review.tunnels()) {
    if (const cases::PlanFit fit = cases::plan_fit(judged, key); !fit.is_valid())
      verdict.wrong.push_back(tunnels::name_of(key) + ": Bone: " + fit.reason);
    if (const auto doubt = plan_review::landmark_doubt(review.landmark_check(key.bone)))
      verdict.wrong.push_back(tunnels::name_of(key) + ": " + *doubt);
    for (const std::string& words : tunnels::wrong_in_words(review.checks(key)))
      verdict.wrong.push_back(tunnels::name_of(key) + ": " + words);
  }
  return verdict;
}

void keep_plan_verdict(const fs::path& case_folder, const PlanVerdict& verdict) {
  std::ostringstream text;
  text << kFirstLine << '\n';
  for (const std::string& wrong : verdict.wrong) text << wrong << '\n';
  files::create_private_folder(plan_verdict_file(case_folder).parent_path());
  files::write_atomically(plan_verdict_file(case_folder), text.str());
}

std::optional<PlanVerdict> plan_verdict(const fs::path& case_folder) {
  const fs::path file = plan_verdict_file(case_folder);
  if (!is_of_now(file, case_folder)) return std::nullopt;
  try {  // a cache: what cannot be read is made again
    std::istringstream text(files::read_text(file));
    std::string line;
    if (!std::getline(text, line) || line != kFirstLine) return std::nullopt;
    PlanVerdict verdict;
    while (std::getline(text, line)) verdict.wrong.push_back(line);
    return verdict;
  } catch (const IoError&) {
    return std::nullopt;
  }
}

}  // namespace arthronaut::workstation_library
