// What a report tells of the session that it is of. Inner header of report.
#pragma once

#include "app/report/flowing_pages.h"
#include "app/report/report_content.h"

namespace arthronaut::report {

void draw_registration(FlowingPages& pages, const registration::RegistrationSummary& registration);
// Steps as the record has them, and what whoever looked at it marked, so many of each. Precondition: there is
// a session.
void draw_time_line(FlowingPages& pages, const Content& content, std::size_t most_rows);

}  // namespace arthronaut::report
