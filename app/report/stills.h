// What the surgeon saw at the moments that matter: recorded pictures with the plan drawn on them. Inner
// header of report.
#pragma once

#include "app/report/flowing_pages.h"
#include "app/report/report_content.h"

namespace arthronaut::report {

// No line runs over a tool, as in the window. Up to three of the session: registered, aimed closest,
// drilled. Cut to the arthroscope's round view; the plan lies where that frame's recorded pose and the
// registration and plan of that moment put it. Says why where there are none, and that one is missing. Of the
// video's file nothing is named. Nothing without a session.
void draw_stills_section(FlowingPages& pages, const Content& content);

}  // namespace arthronaut::report
