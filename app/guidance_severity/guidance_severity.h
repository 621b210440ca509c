// What is read off one moment of navigation: the names of the markers, the numbers of the guide and whether
// they are good. Navigate and Review ask here, so that both say the same.
#pragma once

#include <string>

#include "app/widgets/controls.h"
#include "navigation/guidance/guidance.h"
#include "navigation/operation/guidance_grades.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::guidance_severity {

// As operation/guidance_grades.h says it. Quiet where no number is valid.
[[nodiscard]] widgets::Severity severity_of(operation::Grade grade);
// Of these numbers alone, which must be valid.
[[nodiscard]] widgets::Severity severity_of_offset(const guidance::GuidanceNumbers& guidance);
[[nodiscard]] widgets::Severity severity_of_angle(const guidance::GuidanceNumbers& guidance);
// Bad where less than 2 mm of the planned length remain, beside the plan of the bone ahead, or the drill is
// about to break out of the bone's far side; caution below 5 mm; quiet else.
[[nodiscard]] widgets::Severity severity_of_drill(const guidance::DrillDepth& drill);
// What remains, or what it is too much, under the name that warns: "Remaining", "Exit near", "Stop: exit",
// "Too deep", "Out of bone". Of a drill beside the plan only what warns (severity not quiet) is to be shown.
// At most as long as "Remaining" and a letter: it stands in a narrow column.
struct DrillText {
  std::string name, mm;
};
[[nodiscard]] DrillText drill_text(const guidance::DrillDepth& drill);
// Why no length may be said of it: "beside the plan", or that nobody knows whether it is, as in older
// records, which do not say where the drill was. Empty: it is at the plan.
[[nodiscard]] std::string_view drill_doubt(const guidance::DrillDepth& drill);

// Where several drills are declared, which one it is, as marker_name() says it; else empty.
[[nodiscard]] std::string drill_name(const tools::ToolSet& tools, const guidance::DrillDepth& drill);

// The two parts of the offset across the plan in anatomical words: "1.2 too anterior", "0.4 too distal", so
// that nobody takes for where to go what is where the guide lies. Their squares add up to the length's.
struct OffsetParts {
  std::string side, up;
};
[[nodiscard]] OffsetParts offset_parts(const guidance::GuidanceNumbers& guidance);

// "probe", "femur marker", ... of a declared marker.
[[nodiscard]] std::string marker_name(const tools::ToolSet& tools, int marker_id);

}  // namespace arthronaut::guidance_severity
