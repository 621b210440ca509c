// What the surgeon saw at the moments that matter: recorded pictures with the plan drawn on them. Inner
// header of report.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/report/flowing_pages.h"
#include "app/report/report_content.h"
#include "app/scene/image.h"

namespace arthronaut::report {

struct Stills {
  std::vector<std::pair<std::string, scene::Image>> pictures = {};  // each with its caption
  std::string why_none = {};                                        // empty: there are some
  bool is_one_missing = false;  // which the video has not, or which cannot be read
  bool has_overlay = true;      // of the plan; not where the case's bone is another than the session's
};

// No line runs over a tool, as in the window. Up to three of the session: registered, aimed closest,
// drilled. Cut to the arthroscope's round view; the plan lies where that frame's recorded pose and the
// registration and plan of that moment put it. Of the video's file nothing is named. Precondition: there is a
// session.
[[nodiscard]] Stills take_stills(const Content& content);

// In a row; says why there are none, and that one is missing.
void draw_stills_section(FlowingPages& pages, const Stills& stills);

}  // namespace arthronaut::report
