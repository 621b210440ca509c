// A clip of the ruler with two markers, as the commands that look at it take it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/command_line/command.h"
#include "navigation/calibration/ruler_sightings.h"

namespace arthronaut::command_line {

struct RulerArguments {
  std::string camera, tools, ruler, video;
  std::optional<double> medium_index;
  std::vector<int> ids;
  double spacing_mm = 10;
  bool fixed_lens = false;
};
// --camera, --tools, --medium, --markers, --spacing-mm, --ruler, --fixed-lens and VIDEO.
void add_ruler_options(CLI::App& command, RulerArguments& arguments);

struct RulerClip {
  calibration::RulerSightingsOptions options;
  // With the most frequent reason why frames were of no use among its reasons, where it has any.
  calibration::FluidCheckSummary summary;
  std::size_t frame_count = 0;  // of the clip
};
// Looks at the whole clip. Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] RulerClip look_at_ruler(const RulerArguments& arguments);

}  // namespace arthronaut::command_line
