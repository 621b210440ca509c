// What the painting screen says, without a window.
#pragma once

#include <string>

#include "app/widgets/controls.h"
#include "planning/import/bone_quality.h"
#include "planning/painting/painting.h"

namespace arthronaut::paint {

// What is shown over the images before it is taken.
enum class Preview { None, Growth, Threshold };

// What to do next, as one sentence.
// is_of_case: nothing was painted yet over the bones that the case has. makes_bones: their surfaces are on
// the way.
[[nodiscard]] std::string next_step(const painting::Painting& painting, Preview preview, bool is_working,
                                    bool is_of_case = false, bool makes_bones = false);

[[nodiscard]] widgets::Severity severity_of(importing::QualityVerdict verdict);

[[nodiscard]] std::string label_name(std::uint8_t label);  // "femur"; "eraser" for nothing

}  // namespace arthronaut::paint
