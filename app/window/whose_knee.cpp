#include "app/window/whose_knee.h"

namespace arthronaut::window {

WhoseLine line_of_case(const std::string& case_name) {
  constexpr std::size_t kLongestTail = 12;
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
