// Planned against achieved, as navigation measured it. Inner header of report.
#pragma once

#include "app/report/flowing_pages.h"
#include "app/report/report_content.h"

namespace arthronaut::report {

// Of one tunnel; of a simulation also as it truly lies. is_own: drilled in the session that is told of, which
// there is then.
void draw_achieved(FlowingPages& pages, const Content& content, const operation::AchievedTunnel& achieved,
                   bool is_own);

}  // namespace arthronaut::report
