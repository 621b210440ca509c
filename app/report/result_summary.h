// What the checks say of the plan, and what came of it, tunnel by tunnel, in a few rows: what whoever opens a
// report looks for first. Inner header of report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/report/flowing_pages.h"
#include "app/report/report_content.h"
#include "navigation/operation/achieved_tunnel.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::report {

// Of one tunnel that is planned, was drilled or was found in a CT.
struct TunnelResult {
  tunnels::TunnelKey key;
  // As navigation measured it: in the session that matters or in an earlier one; null: no pose shows it.
  const operation::AchievedTunnel* navigated = nullptr;
  bool is_by_word = false;  // the last that was said of it: drilled, and no pose shows where
  const postop::Comparison* imaged = nullptr;  // with a CT after the operation; null: none is kept
  // From what navigation measured to what the CT shows, in the bone; where both are known, and where the axis
  // runs is relied on in the CT. What neither can say by itself: how far the navigation was from the truth.
  std::optional<operation::TunnelDifference> navigated_to_imaged = {};
};

// In the order of the keys. The pointers are into `content`.
[[nodiscard]] std::vector<TunnelResult> results_of(const Content& content);

// Before any number: what the checks come to, tunnel by tunnel. Which they all are stands on the plan's
// sheet.
void draw_plan_verdicts(FlowingPages& pages, const Content& content);
// Nothing where nothing was drilled, registered or compared yet.
void draw_result_summary(FlowingPages& pages, const Content& content);

}  // namespace arthronaut::report
