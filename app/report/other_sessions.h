// What the sessions beside the one that is told of add to a report. Inner header of report.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/report/flowing_pages.h"
#include "app/report/report_content.h"

namespace arthronaut::report {

// A broken session takes nothing else away: it is named, and another one is told of. Where the case lies is
// told nowhere: a folder may bear the patient's name.
void unless_unreadable(const std::filesystem::path& session, Content& content,
                       const std::function<void()>& read);

// Which tunnels were said to be drilled, and which were drilled, in sessions before; `content` has its own
// session and what was achieved in it. sessions: the oldest first.
void add_other_sessions(const std::vector<std::filesystem::path>& sessions, Content& content);

// Which sessions are in the report in part, and which not at all.
void draw_missing_sessions(FlowingPages& pages, const Content& content);

// A table of each: its registration, and what stood against a mistake.
void draw_other_sessions(FlowingPages& pages, const Content& content);

// That it was said, when, and why no number is told of it.
[[nodiscard]] std::string in_words(const Content::ByWord& said);

}  // namespace arthronaut::report
