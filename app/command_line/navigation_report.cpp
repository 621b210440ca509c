#include "app/command_line/navigation_report.h"

#include <algorithm>
#include <cmath>

#include "app/command_line/tracking_report.h"

namespace arthronaut::command_line {

namespace {

void say_registration(const Context& context, const theatre::NavigationSummary& summary) {
  if (!summary.registration || !summary.registration->has_pose) return context.say("registration: none");
  const registration::RegistrationSummary& r = *summary.registration;
  // Given ones may not say of how many points they are.
  const std::string points =
      r.point_count > 0 ? format("rms %.2f mm over %d points, ", r.rms_mm, r.point_count) : "";
  context.say(format("registration (%s): %spredicted error %.2f mm at the target, %s",
                     summary.registration_was_found ? "found" : "given", points.c_str(), r.predicted_tre_mm,
                     r.reliable ? "reliable" : "not reliable"));
  for (const std::string& assumption : r.assumptions) context.say("  " + assumption);
}

void say_contour(const Context& context, const theatre::NavigationSummary& summary) {
  if (summary.frames_registered == 0) return;
  context.say(format("bone in the picture: where it lay in %ld of %ld frames, not told in the others",
                     summary.frames_bone_seen, summary.frames_registered));
  if (summary.frames_bone_otherwise > 0)
    context.say(format("  in %ld of them it did not look as it did: touch the control point",
                       summary.frames_bone_otherwise));
}

void say_guidance(const Context& context, const theatre::NavigationSummary& summary) {
  const guidance::GuidanceNumbers& g = summary.last_guidance;
  const std::string why_not = summary.guidance_counts.reasons_of_most();
  if (!g.is_valid()) {
    context.say("guidance: none; at the end: " + std::string(guidance::to_text(summary.last_state)));
    if (!why_not.empty()) context.say("  frames without it: " + why_not);
    return;
  }
  // How far the axis is off is said once, as the screen has it: square to the guide it would be another
  // number.
  context.say(format("guidance in %ld of %ld frames; the last: guide to entry %.2f mm, angle %.2f deg",
                     summary.guidance_counts.of(guidance::GuidanceState::Valid),
                     summary.statistics.frame_count, g.tip_to_entry_mm, g.angle_deg));
  if (!why_not.empty()) context.say("  frames without it: " + why_not);
  const auto part = [&](landmarks::AnatomicalDirection direction) {
    const double value_mm = g.offset_in_mm(direction);
    return format("%.2f mm ", std::abs(value_mm)) + std::string(landmarks::to_text(direction, value_mm >= 0));
  };
  context.say(format(
      "  offset of the axis %.2f mm: %s, %s; guide %.1f mm %s the entry; one sigma %.2f mm, %.2f deg",
      g.offset_mm, part(g.across_plan.side_is).c_str(), part(g.across_plan.up_is).c_str(),
      std::abs(g.depth_mm), g.depth_mm < 0 ? "short of" : "beyond", g.sigma_offset_mm, g.sigma_angle_deg));
  if (g.drill && g.drill->is_beside_plan())
    context.say(format("  drill %.1f mm beside the plan: nothing is said of what remains",
                       std::max(g.drill->lateral_mm, g.drill->exit_lateral_mm)) +
                (std::isfinite(g.drill->to_exit_mm)
                     ? format("; %.1f mm to where it leaves the bone (+- %.1f mm)", g.drill->to_exit_mm,
                              g.drill->sigma_mm)
                     : ""));
  else if (g.drill)
    context.say(format("  drill %.1f mm deep, %.1f mm remaining, %.1f mm to the exit (+- %.1f mm)",
                       g.drill->depth_mm, g.drill->remaining_mm, g.drill->to_exit_mm, g.drill->sigma_mm));
}

std::string times_more(std::size_t count) {
  return "and " + std::to_string(count) + (count == 1 ? " time more" : " times more");
}

// Of a live source: what was wrong with it, and how old guidance was.
void say_source(const Context& context, const theatre::NavigationSummary& summary) {
  constexpr std::size_t kMostTold = 5;
  for (std::size_t i = 0; i < std::min(kMostTold, summary.troubles.size()); ++i)
    context.say("source: " + summary.troubles[i]);
  if (summary.troubles.size() > kMostTold)
    context.say("source: " + times_more(summary.troubles.size() - kMostTold));
  for (std::size_t i = 0; i < std::min(kMostTold, summary.tracker_troubles.size()); ++i)
    context.say("tracker: " + summary.tracker_troubles[i]);
  if (summary.tracker_troubles.size() > kMostTold)
    context.say("tracker: " + times_more(summary.tracker_troubles.size() - kMostTold));
  const theatre::StageLatency& all = theatre::of(summary.latency, theatre::Stage::ToGuidance);
  if (all.count == 0) return;
  context.say(format(
      "latency: %.1f ms from capture to guidance in the median, 99 %% within %.1f ms, at worst %.1f ms",
      all.median_ms, all.p99_ms, all.worst_ms));
  for (std::size_t i = 0; context.verbose && i < theatre::kStageCount; ++i)
    if (const theatre::StageLatency& stage = summary.latency[i]; stage.count > 0)
      context.say(format("  %s: %.1f ms, 99 %% within %.1f ms, at worst %.1f ms",
                         std::string(theatre::to_text(static_cast<theatre::Stage>(i))).c_str(),
                         stage.median_ms, stage.p99_ms, stage.worst_ms));
}

}  // namespace

void say_navigation(const Context& context, const theatre::NavigationSummary& summary) {
  if (!summary.ending.empty()) context.say("the source ended: " + summary.ending);
  say_source(context, summary);
  if (summary.frames_in_other_medium > 0)
    context.say(format("medium: in %ld of %ld frames %s", summary.frames_in_other_medium,
                       summary.statistics.frame_count, pipeline::reason_text(summary.other_medium).c_str()));
  say_statistics(context, summary.statistics);
  context.say(format("strokes: %.0f mm in %zu points", summary.drawn_length_mm, summary.curves.size()));
  say_registration(context, summary);
  say_contour(context, summary);
  say_guidance(context, summary);
}

}  // namespace arthronaut::command_line
