// What an import that was refused asks a person, in words.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "planning/import/failure_reason.h"

namespace arthronaut::start {

// "Mesh: femur.stl is 0.46 mm large in millimetres, as no bone of the knee is. As metres it is 462 mm: press
// M"
[[nodiscard]] std::string unit_question(const std::string& mesh, const importing::Failure& refusal);

// "label 5: 98 cm3, 77 x 65 x 62 mm"; "none of the labels" where none is chosen.
[[nodiscard]] std::string chosen_label(const std::vector<importing::FoundLabel>& labels,
                                       const std::map<bones::BoneKind, int>& chosen, bones::BoneKind bone);

// The bone gets the next label that is not the other bone's; after the last one none, then the first.
void choose_next_label(const std::vector<importing::FoundLabel>& labels,
                       std::map<bones::BoneKind, int>& chosen, bones::BoneKind bone);

}  // namespace arthronaut::start
