#include "app/setup/fluid_display.h"

#include <algorithm>

#include "navigation/camera/medium.h"

namespace arthronaut::setup {

namespace {

using widgets::fixed;
using widgets::Severity;

std::string pair_text(double mm, double deg) {
  if (mm < 0 || deg < 0) return "\u2013";
  return hundredths(mm) + " mm,  " + hundredths(deg) + "\u00B0";
}

void judge(const FluidStatus& job, FluidDisplay& display) {
  const calibration::FluidCheckSummary& summary = *job.summary;
  const std::string medium = camera::medium_to_text(job.refractive_index);
  for (const auto& row : summary.rows) {
    const bool is_best = &row == &summary.rows.front();
    display.models.push_back(
        {is_best ? (summary.is_trusted() ? Severity::Good : Severity::Caution) : Severity::Quiet,
         std::string(calibration::to_text(row.hypothesis)),
         row.rms_px < 0 ? "\u2013" : fixed(row.rms_px, 2) + " px", pair_text(row.median_mm, row.median_deg),
         pair_text(row.worst_mm, row.worst_deg)});
  }
  display.numbers.push_back({Severity::Quiet, "Pictures", std::to_string(summary.frame_count)});
  if (summary.best_index > 0)
    display.numbers.push_back(
        {Severity::Quiet, "Index by the pictures",
         fixed(summary.best_index, 3) + "  (" + medium + ": " + fixed(job.refractive_index, 3) + ")"});
  display.reasons = summary.reasons;
  if (summary.is_trusted())
    display.verdict = {Severity::Good, "The camera measures rightly in " + medium,
                       summary.rows.empty()
                           ? ""
                           : std::string(calibration::to_text(summary.rows.front().hypothesis)) +
                                 " explains the pictures best"};
  else
    display.verdict = {Severity::Bad, "Not to be trusted in " + medium,
                       summary.reasons.empty() ? "" : summary.reasons.front()};
}

Band band_of(const FluidRunStatus& status, const FluidDisplay& display) {
  const FluidStatus& job = status.job;
  const std::string count = std::to_string(job.sighting_count) + " pictures counted";
  if (status.phase == FeedPhase::Failed) return {Severity::Bad, "No picture", status.message};
  if (job.picture == nullptr) return {Severity::Quiet, "Waiting for the first picture", ""};
  if (job.is_checking) return {Severity::Quiet, "Checking", count};
  if (job.summary != nullptr) return {Severity::Quiet, "Done", count};
  if (status.phase == FeedPhase::Ended) return {Severity::Caution, "The pictures have ended", count};
  if (!display.is_live) return {Severity::Bad, "No new picture", reason_of(status)};
  if (!job.look.is_taken)
    return {Severity::Caution, "Hold the ruler before the lens", "Not counted: " + job.look.reason};
  return {Severity::Good, "Hold the ruler before the lens and move it",
          fixed(std::min(job.seconds, kFluidCheck_s), 0) + " of " + fixed(kFluidCheck_s, 0) + " s, " + count};
}

}  // namespace

FluidDisplay fluid_display(const FluidRunStatus& status, double now_s) {
  const FluidStatus& job = status.job;
  FluidDisplay display;
  display.is_live = job.picture != nullptr && status.is_of_now(now_s);
  display.progress = job.summary != nullptr ? 1 : std::clamp(job.seconds / kFluidCheck_s, 0.0, 1.0);
  if (job.summary != nullptr) judge(job, display);
  display.band = band_of(status, display);
  if (job.summary != nullptr) {
    display.next = job.summary->is_trusted() ? FluidStep::Done : FluidStep::Again;
    display.next_text = job.summary->is_trusted() ? "go on to the operation" : "check again";
  } else if (job.is_checking) {
    display.next_text = "wait for the check";
  } else if (status.phase == FeedPhase::Ended && job.sighting_count > 0) {
    display.next = FluidStep::Check;
    display.next_text = "check with the pictures there are";
  } else if (status.phase == FeedPhase::Ended || status.phase == FeedPhase::Failed) {
    display.next = FluidStep::Again;
    display.next_text = "start again, or choose another source (O)";
  } else {
    display.next_text = "hold the ruler before the lens";
  }
  return display;
}

}  // namespace arthronaut::setup
