// Whose knee is on the screen, in lines of which a part may be cut short and the rest never: two patients of
// one name are told apart by their birth dates, and a wrong side is a wrong operation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/cases/identity.h"

namespace arthronaut::window {

struct WhoseLine {
  std::string may_be_cut, rest;
  bool is_of_patient = false;
};

// The name of a case: its last word tells two of a day apart, and is never cut unless it is long itself.
[[nodiscard]] WhoseLine line_of_case(const std::string& case_name);

// The patient as far as known, the name of the case, its side. Two or three lines: of a case without a
// patient its name has one to itself, which tells two of a day apart.
[[nodiscard]] std::vector<WhoseLine> whose_knee(const std::optional<cases::Identity>& identity,
                                                const std::string& case_name, bones::Side side);

}  // namespace arthronaut::window
