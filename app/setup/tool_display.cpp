#include "app/setup/tool_display.h"

#include <algorithm>

namespace arthronaut::setup {

namespace {

using widgets::fixed;
using widgets::Severity;

std::string point_text(const Eigen::Vector3d& point) {
  return fixed(point.x(), 2) + ",  " + fixed(point.y(), 2) + ",  " + fixed(point.z(), 2) + " mm";
}

std::string at_most(double limit, int decimals) { return "at most " + fixed(limit, decimals); }

// Below 0: a half that tells no tip of its own.
std::string half_in_words(double change_mm) {
  return change_mm >= 0 ? hundredths(change_mm) + " mm" : "no tip by one alone";
}

std::vector<Row> tip_rows(const tools::PivotCalibrationSummary& tip) {
  const tools::PivotCalibrationOptions limits;
  std::vector<Row> rows;
  rows.push_back(limited("Different poses", tip.distinct_count >= limits.min_distinct_poses,
                         std::to_string(tip.distinct_count),
                         "at least " + std::to_string(limits.min_distinct_poses)));
  rows.push_back(limited("Cone", tip.cone_deg >= limits.min_cone_deg, fixed(tip.cone_deg, 0) + "\u00B0",
                         "at least " + fixed(limits.min_cone_deg, 0) + "\u00B0"));
  if (!tip.has_tip()) return rows;
  rows.push_back(limited("Residual", tip.rms_mm <= limits.max_rms_mm, hundredths(tip.rms_mm) + " mm",
                         at_most(limits.max_rms_mm, 1)));
  rows.push_back(limited("Tip known to", tip.sigma_mm <= limits.max_sigma_mm,
                         "\u00B1 " + fixed(std::max(tip.sigma_mm, 0.01), 2) + " mm",
                         at_most(limits.max_sigma_mm, 2)));
  rows.push_back(limited("Bias by noise", tip.bias_mm <= limits.max_bias_mm, hundredths(tip.bias_mm) + " mm",
                         at_most(limits.max_bias_mm, 1)));
  const bool is_compared = tip.half_change_mm >= 0;
  rows.push_back(limited("First half against second",
                         is_compared && tip.half_change_mm <= limits.max_half_change_mm,
                         half_in_words(tip.half_change_mm), at_most(limits.max_half_change_mm, 2)));
  rows.push_back({Severity::Quiet, "Left out",
                  std::to_string(tip.pose_count - tip.inlier_count) + " of " +
                      std::to_string(tip.pose_count) + " poses"});
  if (!tip.is_usable()) return rows;  // a tip that can't be stood for is not shown
  rows.push_back({Severity::Quiet, "Tip from the marker", point_text(tip.tip_in_tool_mm)});
  return rows;
}

std::vector<Row> axis_rows(const tools::SpinCalibrationSummary& axis) {
  const tools::SpinCalibrationOptions limits;
  std::vector<Row> rows;
  rows.push_back(limited("Poses", axis.pose_count >= limits.min_poses, std::to_string(axis.pose_count),
                         "at least " + std::to_string(limits.min_poses)));
  rows.push_back(limited("Turned by", axis.turn_deg >= limits.min_turn_deg,
                         fixed(axis.turn_deg, 0) + "\u00B0",
                         "at least " + fixed(limits.min_turn_deg, 0) + "\u00B0"));
  if (!axis.has_axis()) return rows;
  rows.push_back(limited("Residual", axis.rms_mm <= limits.max_rms_mm, hundredths(axis.rms_mm) + " mm",
                         at_most(limits.max_rms_mm, 1)));
  rows.push_back(limited("Direction known to", axis.direction_sigma_deg <= limits.max_direction_sigma_deg,
                         "\u00B1 " + fixed(std::max(axis.direction_sigma_deg, 0.01), 2) + "\u00B0",
                         at_most(limits.max_direction_sigma_deg, 1) + "\u00B0"));
  rows.push_back({Severity::Quiet, "Wobble", hundredths(axis.wobble_deg) + "\u00B0"});
  rows.push_back({Severity::Quiet, "Left out",
                  std::to_string(axis.pose_count - axis.inlier_count) + " of " +
                      std::to_string(axis.pose_count) + " poses"});
  if (!axis.is_usable()) return rows;  // an axis that can't be stood for is not shown
  rows.push_back({Severity::Quiet, "Axis from the marker", point_text(axis.axis_point_in_tool_mm)});
  rows.push_back({Severity::Quiet, "Direction",
                  fixed(axis.axis_direction_in_tool.x(), 3) + ",  " +
                      fixed(axis.axis_direction_in_tool.y(), 3) + ",  " +
                      fixed(axis.axis_direction_in_tool.z(), 3)});
  return rows;
}

std::string motion_of(const ToolChoice& choice) {
  return choice.task == ToolTask::Tip ? "Rest the tip in a dimple and swing the " + choice.tool_name
                                      : "Turn the " + choice.tool_name + " about its axis";
}

Band band_of(const ToolRunStatus& status, const ToolChoice& choice, const ToolDisplay& display) {
  const ToolStatus& job = status.job;
  if (status.phase == FeedPhase::Failed) return {Severity::Bad, "No picture", status.message};
  if (job.picture == nullptr) return {Severity::Quiet, "Waiting for the first picture", ""};
  if (!job.is_collecting) return {Severity::Good, "Done", "No more poses are taken"};
  if (status.phase == FeedPhase::Ended)
    return {display.can_adopt ? Severity::Good : Severity::Caution, "The pictures have ended",
            std::to_string(job.pose_count) + " poses were taken"};
  if (!display.is_live) return {Severity::Bad, "No new picture", reason_of(status)};
  if (!job.reason.empty()) return {Severity::Caution, motion_of(choice), "Not counted: " + job.reason};
  return {Severity::Good, motion_of(choice), std::to_string(job.pose_count) + " poses taken"};
}

void judge(const ToolResult& result, const ToolContext& context, ToolDisplay& display) {
  const bool is_tip = result.task == ToolTask::Tip;
  display.numbers = is_tip ? tip_rows(result.tip) : axis_rows(result.axis);
  display.reasons = is_tip ? result.tip.reasons : result.axis.reasons;
  display.can_adopt = result.is_usable() && !context.is_adopted && context.kept_because.empty();
  if (context.is_adopted)
    display.verdict = {Severity::Good, "Adopted", "It stands in this case's tools.json with its residual."};
  else if (result.is_usable() && !context.kept_because.empty())
    display.verdict = {Severity::Caution, "Not adopted", context.kept_because};
  else if (result.is_usable())
    display.verdict = {Severity::Good, "Fit for guidance", "Space adopts it for this case."};
  else
    display.verdict = {Severity::Caution, "Not yet",
                       display.reasons.empty() ? (is_tip ? result.tip.message : result.axis.message)
                                               : display.reasons.front()};
}

}  // namespace

ToolDisplay tool_display(const ToolRunStatus& status, const ToolChoice& choice, const ToolContext& context,
                         double now_s) {
  const ToolStatus& job = status.job;
  ToolDisplay display;
  display.is_live = job.picture != nullptr && status.is_of_now(now_s);
  for (const ToolStatus::Seen& marker : job.markers)
    display.markers.push_back({!display.is_live ? Severity::Quiet
                               : marker.stands  ? Severity::Good
                                                : Severity::Caution,
                               marker.name, display.is_live ? marker.text : "no live picture"});
  if (job.result != nullptr) judge(*job.result, context, display);
  const bool is_over = status.phase == FeedPhase::Ended || status.phase == FeedPhase::Failed;
  if (is_over && job.result != nullptr && !job.result->is_usable()) {
    display.verdict.severity = Severity::Bad;
    display.verdict.headline = "Refused: not adopted";
  }
  display.band = band_of(status, choice, display);
  if (context.is_adopted) {
    display.next = ToolStep::Done;
    display.next_text = "go on to the " + (context.next_tool.empty() ? "fluid check" : context.next_tool);
  } else if (display.can_adopt && context.result_stands_s < kReading_s) {
    display.next_text = "read the result";
  } else if (display.can_adopt) {
    display.next = ToolStep::Adopt;
    display.next_text = choice.task == ToolTask::Tip ? "adopt the tip" : "adopt the axis";
  } else if (is_over) {
    display.next = ToolStep::Again;
    display.next_text = "start again, or choose another source (O)";
  } else {
    display.next_text = choice.task == ToolTask::Tip ? "swing the tool on its tip" : "turn the tool";
  }
  return display;
}

}  // namespace arthronaut::setup
