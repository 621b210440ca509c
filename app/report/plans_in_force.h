// By which plans a session guided, and whether the case plans something else by now. Inner header of report.
#pragma once

#include <string>
#include <vector>

#include "app/report/report_content.h"
#include "navigation/operation/command.h"

namespace arthronaut::report {

struct PlanInForce {
  const recording::SessionEvent* event = nullptr;  // that put it in force; of the session
  operation::PlannedTunnel plan;
  double since_s = 0;  // from the first picture
};

// In the order of time. Not among them: what was replaced before the first picture, and what the case was
// planned to be after the source had ended. Throws InvalidInput for a plan that cannot be read.
[[nodiscard]] std::vector<PlanInForce> plans_in_force(const recording::RecordedSession& session);
// "femur, 8.0 mm wide, 41.1 mm long"
[[nodiscard]] std::string in_words(const operation::PlannedTunnel& plan);
// The first one, and each other one with when it came: "femur, ...; from 0:33.4 femur, ..."; empty: none.
[[nodiscard]] std::string plans_in_words(const std::vector<PlanInForce>& plans);
// That it was changed in the session, and that the case's plan is not the one any more that guided there: a
// sentence each.
[[nodiscard]] std::vector<std::string> plan_warnings(const recording::RecordedSession& session,
                                                     const Content& content);

}  // namespace arthronaut::report
