// The report's numbers for other programs: the same content as JSON, and as a table. Inner header of report.
#pragma once

#include <string>

#include "app/report/report_content.h"

namespace arthronaut::report {

// {"format": "arthronaut.report", "version": 1, ...}: case, tunnels with their checks, session with its
// registration, steps, marks, planned against achieved as navigated and as images after the operation
// show it, versions.
[[nodiscard]] std::string report_json(const Content& content, const ReportOptions& options);
// The same, one value a row: "quantity,value", the quantity as a path: "tunnels/0/entry_mm/1". RFC 4180.
[[nodiscard]] std::string report_csv(const Content& content, const ReportOptions& options);

}  // namespace arthronaut::report
