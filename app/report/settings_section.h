// What the figures of a report hang on: camera, tools and versions. Inner header of report.
#pragma once

#include "app/report/flowing_pages.h"
#include "app/report/report.h"
#include "app/report/report_content.h"

namespace arthronaut::report {

// Camera and tools where the case and its session have them; versions always.
void draw_settings_section(FlowingPages& pages, const Content& content, const ReportOptions& options);

}  // namespace arthronaut::report
