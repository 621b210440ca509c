// What stands on the screen while the fluid is checked: a pure function of the run's status.
#pragma once

#include <string>
#include <vector>

#include "app/setup/fluid_job.h"
#include "app/setup/station.h"

namespace arthronaut::setup {

enum class FluidStep { Wait, Check, Again, Done };

struct FluidDisplay {
  bool is_live = false;
  Band band;            // what to do, or what is wrong with what is seen
  double progress = 0;  // 0 to 1, of the five seconds
  struct Model {        // one line of the table, best first
    widgets::Severity severity = widgets::Severity::Quiet;
    std::string name, corners, median, worst;
  };
  std::vector<Model> models;
  std::vector<Row> numbers;
  Band verdict;  // empty headline: not checked yet
  std::vector<std::string> reasons;
  FluidStep next = FluidStep::Wait;
  std::string next_text;
};

using FluidRunStatus = RunStatus<FluidStatus>;

[[nodiscard]] FluidDisplay fluid_display(const FluidRunStatus& status, double now_s);

}  // namespace arthronaut::setup
