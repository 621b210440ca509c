#include "app/window/whose_knee.h"

#include <string_view>

namespace arthronaut::window {

namespace {

// Of "Knee 2026-11-24 14:05:31", as cases are called that nobody named, where the month begins: without it
// two knees of one hour look alike. npos of another name.
std::size_t month_of_time(const std::string& name) {
  constexpr std::string_view kTime = "0000-00-00 00:00:00";
  constexpr std::size_t kYear = 5;
  if (name.size() < kTime.size()) return std::string::npos;
  const std::size_t begin = name.size() - kTime.size();
  for (std::size_t i = 0; i < kTime.size(); ++i) {
    const char c = name[begin + i];
    if (kTime[i] == '0' ? c < '0' || c > '9' : c != kTime[i]) return std::string::npos;
  }
  return begin + kYear;
}

}  // namespace

WhoseLine line_of_case(const std::string& case_name) {
  constexpr std::size_t kLongestTail = 12;
  if (const std::size_t month = month_of_time(case_name); month != std::string::npos)
    return {case_name.substr(0, month), case_name.substr(month), false};
  const std::size_t blank = case_name.rfind(' ');
  if (blank == std::string::npos || blank == 0 || case_name.size() - blank > kLongestTail)
    return {case_name, "", false};
  return {case_name.substr(0, blank), case_name.substr(blank), false};
}

std::vector<WhoseLine> whose_knee(const std::optional<cases::Identity>& identity,
                                  const std::string& case_name, bones::Side side) {
  std::vector<WhoseLine> lines;
  if (identity) {
    const std::string name = identity->name_in_words();
    // A pseudonym often stands in both: once is enough.
    const std::string id = identity->patient_id == name ? "" : identity->patient_id;
    if (!name.empty()) lines.push_back({name, "", true});
    const std::string born = identity->birth_date_in_words();
    if (!id.empty() || !born.empty())
      lines.push_back({id, (id.empty() || born.empty() ? "" : "  \u00B7  ") + born, true});
  }
  const std::string knee = std::string(bones::to_text(side)) + " knee";
  WhoseLine of_case = line_of_case(case_name);
  if (lines.size() < 2) {  // there is room for the whole name
    lines.push_back(of_case);
    lines.push_back({"", knee, false});
    return lines;
  }
  of_case.rest += "  \u2013  " + knee;
  lines.push_back(of_case);
  return lines;
}

}  // namespace arthronaut::window
