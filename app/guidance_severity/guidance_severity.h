// What is read off one moment of navigation: the names of the markers, the numbers of the guide and whether
// they are good. Navigate and Review ask here, so that both say the same.
#pragma once

#include <string>

#include "app/widgets/controls.h"
#include "navigation/guidance/guidance.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::guidance_severity {

// Good: offset under 1 mm, angle under 2 degrees, each with a predicted error (one sigma) under the same
// number. Caution: under 2 mm and 4 degrees. Bad: anything else, and whatever is known to no better than
// that. The program's own thresholds.
[[nodiscard]] widgets::Severity severity_of_offset(const guidance::GuidanceNumbers& guidance);
[[nodiscard]] widgets::Severity severity_of_angle(const guidance::GuidanceNumbers& guidance);
// Bad where less than 2 mm of the planned length remain or the drill is about to break out of the bone's far
// side, caution below 5 mm; quiet else.
[[nodiscard]] widgets::Severity severity_of_drill(const guidance::DrillDepth& drill);
// What remains, or what it is too much, under the name that warns: "Remaining", "Exit near", "Stop: exit",
// "Too deep". At most as long as "Remaining" and a letter: it stands in a narrow column.
struct DrillText {
  std::string name, mm;
};
[[nodiscard]] DrillText drill_text(const guidance::DrillDepth& drill);

// Length of the offset in the plane across the plan.
[[nodiscard]] double offset_mm(const guidance::GuidanceNumbers& guidance);
// Its two parts in anatomical words: "1.2 anterior", "0.4 distal". Their squares add up to the length's.
struct OffsetParts {
  std::string side, up;
};
[[nodiscard]] OffsetParts offset_parts(const guidance::GuidanceNumbers& guidance);

// "probe", "femur marker", ... of a declared marker.
[[nodiscard]] std::string marker_name(const tools::ToolSet& tools, int marker_id);

}  // namespace arthronaut::guidance_severity
