// Rows of the tracking panel that are words alone. Pure. Precondition of all: what is known is of the source
// that was started last (is_of_source_before() is false).
#pragma once

#include <string>
#include <vector>

#include "app/navigate/navigate_display.h"
#include "app/navigate/registration_words.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::navigate {

// What a time-out reads out, whether or not one was asked for, in few lines: the patient stands in the title,
// camera and tools with the source.
[[nodiscard]] std::vector<SeverityText> beginning_rows(const operation::OperationState& state,
                                                       const std::string& patient,
                                                       const plan_review::TunnelVerdict& verdict);
// Whether the picture shows the registered bone where it lay, or why that is not checked: good never, since
// it makes nothing more sure. Empty while no registration stands or an alarm of another kind holds.
[[nodiscard]] std::vector<SeverityText> contour_rows(const operation::OperationState& state);
// What is wrong with a live source, and how long its pictures take: medians, in brackets what 99 of 100 keep.
// Empty for other sources.
[[nodiscard]] std::vector<SeverityText> source_rows(const theatre::LiveState& live);
// For a line that stands while nothing, or no video though it was asked for, is recorded; empty else.
[[nodiscard]] std::string record_notice(const theatre::LiveState& live, bool wants_video);
// Whether something is recorded, and how fast pictures come. The journal is written in any case: what is
// worth saying is that it is not, and whether video is kept. Nothing of a source that gives no pictures now.
[[nodiscard]] std::vector<SeverityText> record_rows(const theatre::LiveState& live,
                                                    const NavigateDisplay& display);

}  // namespace arthronaut::navigate
