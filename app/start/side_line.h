// What the import's page says of the side, and how sure that is: a wrong side is a wrong operation.
#pragma once

#include <optional>
#include <string>

#include "app/widgets/controls.h"
#include "planning/import/bone_import.h"

namespace arthronaut::start {

struct SideLine {
  widgets::Severity severity = widgets::Severity::Caution;
  std::string text;
  // Nobody chose it, and what told it does not make it sure: no case is made before somebody has.
  bool needs_choice = false;
};
// was_said: a person chose it, before the import or after. Good where a person or the fibula says it, Bad
// where they say different things; what a name or the bones' shape alone tells is to be looked at.
[[nodiscard]] SideLine side_line(const importing::BoneImport& import, std::optional<bones::Side> side,
                                 bool was_said);

}  // namespace arthronaut::start
