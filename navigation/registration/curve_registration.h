// The parts of register_curves that registering on the fly needs too.
#pragma once

#include <string_view>

#include "navigation/registration/prepared_bone.h"

namespace arthronaut::registration {

// Whose side's bone was touched, judged by how well its mirror image fits beside it.
enum class SideVerdict { Own, Unclear, Other };
[[nodiscard]] std::string_view reason_against(SideVerdict verdict);  // empty for Own

struct SearchOutcome {
  RegistrationSummary summary;
  bool fits = false;        // the shape does, however well it is held
  bool fits_amply = false;  // by so much that no other shape could
  double cost = 1e9;        // of the pose, see RefinedPose
  double measurements = 0;  // independent ones that the points make
};

// Global search, refinement and verdict. max_rounds bounds the search where no pose leads clearly.
[[nodiscard]] SearchOutcome search_and_summarise(const PreparedBone::Data& bone, const strokes::Curves& curves,
                                                 const RegistrationOptions& options, int max_rounds);

// found: on the bone itself.
[[nodiscard]] SideVerdict judge_side(const PreparedBone::Data& bone, const strokes::Curves& curves,
                                     const RegistrationOptions& options, const SearchOutcome& found);

}  // namespace arthronaut::registration
