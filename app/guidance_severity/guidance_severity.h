// What is read off one moment of navigation: the names of the markers, the numbers of the guide and whether
// they are good. Navigate and Review ask here, so that both say the same.
#pragma once

#include <string>

#include "app/widgets/controls.h"
#include "navigation/guidance/guidance.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::guidance_severity {

// Good: offset under 1 mm, angle under 2 degrees and a predicted offset error under 1 mm. Caution: under 2 mm
// and 4 degrees. Bad: anything else. The program's own thresholds (methods: quantities of guidance).
[[nodiscard]] widgets::Severity severity_of_offset(const guidance::GuidanceNumbers& guidance);
[[nodiscard]] widgets::Severity severity_of_angle(const guidance::GuidanceNumbers& guidance);
// Bad where less than 2 mm of the planned length remain, caution below 5 mm.
[[nodiscard]] widgets::Severity severity_of_remaining(const guidance::GuidanceNumbers& guidance);

// Length of the offset in the plane across the plan.
[[nodiscard]] double offset_mm(const guidance::GuidanceNumbers& guidance);

// "probe", "femur marker", ... of a declared marker.
[[nodiscard]] std::string marker_name(const tools::ToolSet& tools, int marker_id);

}  // namespace arthronaut::guidance_severity
