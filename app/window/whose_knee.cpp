#include "app/window/whose_knee.h"

namespace arthronaut::window {

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
  if (lines.empty()) return {{case_name, "", false}, {"", knee, false}};  // there is room for the whole name
  lines.push_back({case_name, "  \u2013  " + knee, false});
  return lines;
}

}  // namespace arthronaut::window
