#include "app/case/case_side.h"

#include "navigation/recording/session_facts.h"
#include "planning/cases/case.h"
#include "planning/cases/case_outline.h"
#include "planning/geometry/error.h"

namespace arthronaut::open_case {

namespace fs = std::filesystem;

importing::SaidSide say_side(const fs::path& case_folder, bones::Side side) {
  const bones::Side before = cases::read_case_outline(case_folder).side;
  if (before == side) return importing::say_side_of_case(case_folder, side);
  const std::string was(bones::to_text(before)), is(bones::to_text(side));
  std::size_t session_count = 0;
  for (const fs::path& folder : cases::session_folders(case_folder)) {
    const library::SessionFacts facts = recording::read_session_facts(folder);
    if (facts.is_exercise) continue;
    if (!facts.problem.empty())
      throw InvalidInput(
          case_folder, "",
          "its session " + facts.id + " cannot be read, and may have drilled by the plan of a " + was +
              " knee: its side stays. Import the bones into another case, as a " + is + " knee");
    if (facts.is_drilled())
      throw InvalidInput(case_folder, "",
                         "its session " + facts.id + " drilled a tunnel by the plan of a " + was +
                             " knee: its side stays. Import the bones into another case, as a " + is +
                             " knee");
    if (facts.side == before) ++session_count;
  }
  importing::SaidSide said = importing::say_side_of_case(case_folder, side);
  if (session_count > 0)
    said.lines.push_back((session_count == 1 ? "a session of it stays"
                                             : std::to_string(session_count) + " sessions of it stay") +
                         " recorded as of a " + was + " knee, and Review and report say so");
  for (const char* made : {"report.pdf", "export"})
    if (fs::exists(case_folder / made))
      said.lines.push_back(std::string(made) + ", which is in the case, is of the side that it had then");
  return said;
}

}  // namespace arthronaut::open_case
