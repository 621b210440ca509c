// The parts of register_curves that registering on the fly needs too.
#pragma once

#include <string_view>

#include "navigation/registration/prepared_bone.h"

namespace arthronaut::registration {

inline constexpr std::string_view kOtherSideReason =
    "the curves fit the mirror image of this bone: it is the bone of the other side";

// Global search, refinement and verdict. max_rounds bounds the search where no pose leads clearly.
[[nodiscard]] RegistrationSummary search_and_summarise(const PreparedBone::Data& bone, const strokes::Curves& curves,
                                                       const RegistrationOptions& options, int max_rounds);

// The bone of the other side fits the curves reliably, and better than what was found.
[[nodiscard]] bool mirror_image_fits_better(const PreparedBone::Data& bone, const strokes::Curves& curves,
                                            const RegistrationOptions& options, const RegistrationSummary& found);

}  // namespace arthronaut::registration
