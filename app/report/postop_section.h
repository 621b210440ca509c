// Planned against achieved, as images after the operation show it. Inner header of report.
#pragma once

#include <vector>

#include "app/report/flowing_pages.h"
#include "app/report/report_content.h"

namespace arthronaut::report {

// One column a tunnel, its verdict and why it is in doubt. A case without a comparison says so.
void draw_postop_section(FlowingPages& pages, const Content& content);

// What may be drawn of it, in the plan's frame: the reliable ones, of today's plan.
[[nodiscard]] std::vector<tunnels::Tunnel> tunnels_in_the_images(const Content& content);

}  // namespace arthronaut::report
