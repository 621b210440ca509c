// What the figures of a report hang on: camera and tools. Inner header of report.
#pragma once

#include "app/report/flowing_pages.h"
#include "app/report/report_content.h"

namespace arthronaut::report {

// Camera and tools of the session, else the case's camera where it has one.
void draw_settings_section(FlowingPages& pages, const Content& content);

}  // namespace arthronaut::report
