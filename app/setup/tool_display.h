// What stands on the screen while a tool is calibrated: a pure function of the run's status.
#pragma once

#include <string>
#include <vector>

#include "app/setup/station.h"
#include "app/setup/tool_job.h"

namespace arthronaut::setup {

enum class ToolStep { Wait, Adopt, Again, Done };

struct ToolDisplay {
  bool is_live = false;
  Band band;                         // what to do, or what is wrong with what is seen
  std::vector<Row> markers;          // that are needed, with the reason where one is not seen
  std::vector<Row> numbers;          // of the calibration so far, each beside its limit
  Band verdict;                      // empty headline: nothing to judge yet
  std::vector<std::string> reasons;  // against it
  bool can_adopt = false;
  ToolStep next = ToolStep::Wait;
  std::string next_text;
};

using ToolRunStatus = RunStatus<ToolStatus>;

// What the station knows beside the run.
struct ToolContext {
  bool is_adopted = false;              // the result shown stands in the case already
  std::string kept_because = "";        // why the case's tools.json may not be changed; empty: it may
  double result_stands_s = kReading_s;  // usable, on the screen
  std::string next_tool = "";           // what the same source can measure next; empty: nothing
};

[[nodiscard]] ToolDisplay tool_display(const ToolRunStatus& status, const ToolChoice& choice,
                                       const ToolContext& context, double now_s);

}  // namespace arthronaut::setup
