// What the painting screen says, without a window.
#pragma once

#include <string>
#include <vector>

#include "app/paint/bone_making.h"
#include "app/widgets/controls.h"
#include "planning/painting/painting.h"

namespace arthronaut::paint {

// What is shown over the images before it is taken.
enum class Preview { None, Growth, Threshold };

// What to do next, as one sentence.
[[nodiscard]] std::string next_step(const painting::Painting& painting, Preview preview, bool is_working);

struct QualityLine {
  widgets::Severity severity = widgets::Severity::Quiet;
  std::string name, text;
};
// A surface that holds more than this share less or more than what was painted is to be looked at.
inline constexpr double kMostVolumeOff_fraction = 0.05;
[[nodiscard]] std::vector<QualityLine> quality_lines(const BoneQuality& quality);

[[nodiscard]] std::string label_name(std::uint8_t label);  // "femur"; "eraser" for nothing

}  // namespace arthronaut::paint
