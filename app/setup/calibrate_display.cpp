#include "app/setup/calibrate_display.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::setup {

namespace {

using widgets::fixed;
using widgets::Severity;

std::string percent(double share) { return fixed(100 * share, 0) + " %"; }

std::vector<Row> quality_rows(const calibration::CaptureAdvice& advice, bool was_taken) {
  const calibration::CaptureLimits limits;
  const calibration::CaptureQuality& q = advice.quality;
  std::vector<Row> rows;
  const lens::LensObservation& lens = advice.picture.lens;
  if (lens.mark == lens::MarkState::Found)
    rows.push_back({Severity::Good, "Lens mark", "at " + fixed(lens.mark_angle_deg, 0) + "\u00B0"});
  else
    rows.push_back({Severity::Caution, "Lens mark", std::string(lens::to_text(lens.mark))});
  if (!advice.picture.board.found()) {
    rows.push_back({Severity::Caution, "Board", "not found: " + advice.picture.board.reason});
    return rows;
  }
  rows.push_back(limited("Corners", q.corner_count >= limits.fewest_corners, std::to_string(q.corner_count),
                         "at least " + std::to_string(limits.fewest_corners)));
  rows.push_back(limited("Coverage", q.coverage >= limits.least_coverage, percent(q.coverage),
                         "at least " + percent(limits.least_coverage)));
  if (q.edge_width_px > 0)
    rows.push_back(limited("Sharpness", q.edge_width_px <= limits.widest_edge_px,
                           "edges " + fixed(q.edge_width_px, 1) + " px",
                           "at most " + fixed(limits.widest_edge_px, 0)));
  else
    rows.push_back({Severity::Quiet, "Sharpness", "not measured"});
  rows.push_back(limited("Glare", q.saturated <= limits.most_saturated, percent(q.saturated),
                         "at most " + percent(limits.most_saturated)));
  if (q.motion_px)
    rows.push_back(limited("Held still", *q.motion_px <= limits.most_motion_px,
                           fixed(*q.motion_px, 1) + " px", "at most " + fixed(limits.most_motion_px, 0)));
  if (q.tilt_deg)  // one of the boards must be tilted, not every one
    rows.push_back(
        {*q.tilt_deg >= limits.wanted_tilt_deg ? Severity::Good : Severity::Quiet, "Tilt",
         fixed(*q.tilt_deg, 0) + "\u00B0  (one of at least " + fixed(limits.wanted_tilt_deg, 0) + "\u00B0)"});
  if (q.turn_deg && !was_taken)  // it is one of the others now
    rows.push_back(limited("Turn from others", *q.turn_deg >= limits.least_turn_deg,
                           fixed(*q.turn_deg, 0) + "\u00B0",
                           "at least " + fixed(limits.least_turn_deg, 0) + "\u00B0"));
  return rows;
}

// As many decimals as the error is worth: a nought must not stand for it.
int decimals_for(double sigma) {
  return sigma > 0 ? std::clamp(static_cast<int>(-std::floor(std::log10(sigma))), 1, 5) : 1;
}

std::vector<Row> result_rows(const calibration::CalibrationSummary& summary) {
  const camera::Calibration& c = summary.record.calibration;
  const auto number = [&](double value, int k) {
    if (!c.covariance) return fixed(value, 1) + " (error not known)";
    const double sigma = std::sqrt((*c.covariance)(k, k));
    return fixed(value, decimals_for(sigma)) + " \u00B1 " + fixed(sigma, decimals_for(sigma));
  };
  const auto point = [&](const Eigen::Vector2d& p, int k) {
    return number(p.x(), k) + ",  " + number(p.y(), k + 1) + " px";
  };
  std::vector<Row> rows;
  rows.push_back({Severity::Quiet, "Focal length", number(c.focal_px, 0) + " px"});
  rows.push_back({Severity::Quiet, "Distortion xi", number(c.distortion_xi, 1)});
  rows.push_back({Severity::Quiet, "Principal point", point(c.principal_point_px, 2)});
  rows.push_back({Severity::Quiet, "Centre of rotation", point(c.rotation_center_px, 4)});
  rows.push_back({Severity::Quiet, "Corners miss by", fixed(summary.rms_px, 2) + " px"});
  if (summary.leave_one_out_rms_px >= 0)
    rows.push_back({Severity::Quiet, "A picture left out", fixed(summary.leave_one_out_rms_px, 2) + " px"});
  rows.push_back({Severity::Quiet, "Working distance", fixed(summary.distance_mm, 1) + " mm"});
  return rows;
}

void judge_result(const CalibrateStatus& job, const CalibrateContext& context, CalibrateDisplay& display) {
  const calibration::CalibrationSummary& summary = *job.summary;
  display.reasons = summary.reasons;
  display.notes = summary.notes;
  if (summary.is_usable()) display.result = result_rows(summary);
  const bool is_good =
      summary.outcome == calibration::CalibrationSummary::Outcome::Ok && summary.reasons.empty();
  display.can_adopt = is_good && !context.is_adopted && context.kept_because.empty();
  if (context.is_adopted)
    display.verdict = {Severity::Good, "Adopted", "This case is navigated with this calibration."};
  else if (is_good && !context.kept_because.empty())
    display.verdict = {Severity::Caution, "Not adopted", context.kept_because};
  else if (is_good)
    display.verdict = {Severity::Good, "Fit for guidance",
                       std::to_string(summary.pictures.size()) + " pictures. Space adopts it for this case."};
  else
    display.verdict = {Severity::Bad, "Refused: not adopted",
                       summary.reasons.empty() ? "" : summary.reasons.front()};
}

Band band_of(const CalibrateRunStatus& status, const CalibrateDisplay& display) {
  const CalibrateStatus& job = status.job;
  if (status.phase == FeedPhase::Failed) return {Severity::Bad, "No picture", status.message};
  if (job.is_calibrating) return {Severity::Quiet, "Calibrating", "from the pictures taken"};
  if (!display.has_picture) return {Severity::Quiet, "Waiting for the first picture", ""};
  const calibration::CaptureAdvice& advice = *job.advice;
  if (job.took_this)
    return {Severity::Good, "Picture " + std::to_string(job.taken.size()) + " taken", advice.wanted};
  if (status.phase == FeedPhase::Ended) {
    if (advice.is_complete) return {Severity::Good, "The pictures have ended", "There are enough: calibrate"};
    return {Severity::Caution, "The pictures have ended",
            "Only " + std::to_string(job.taken.size()) + " could be taken; choose another source"};
  }
  if (status.awaits_still) return {Severity::Quiet, "The next picture comes", ""};
  if (!display.is_live) return {Severity::Bad, "No new picture", reason_of(status)};
  if (!job.note.empty() && !advice.is_good()) return {Severity::Caution, advice.wanted, job.note};
  std::string detail;  // what the headline does not say yet
  for (const std::string& reason : advice.rejections)
    if (advice.wanted.find(reason) == std::string::npos) detail += (detail.empty() ? "" : "; ") + reason;
  if (advice.is_complete && !detail.empty()) detail = "This one is not taken: " + detail;
  return {advice.is_good() || advice.is_complete ? Severity::Good : Severity::Caution, advice.wanted, detail};
}

}  // namespace

CalibrateDisplay calibrate_display(const CalibrateRunStatus& status, const CalibrateContext& context,
                                   double now_s) {
  const CalibrateStatus& job = status.job;
  CalibrateDisplay display;
  display.has_picture = job.picture != nullptr && job.advice != nullptr;
  display.is_live = display.has_picture && status.phase == FeedPhase::Running && !status.awaits_still &&
                    (status.is_stills || status.is_of_now(now_s));
  const bool is_free = !job.is_calibrating;
  const bool is_enough = job.advice != nullptr && job.advice->is_complete;
  const auto fewest = static_cast<std::size_t>(calibration::CaptureLimits{}.fewest_pictures);
  if (display.has_picture) display.quality = quality_rows(*job.advice, job.took_this);
  display.can_take = is_free && display.is_live && job.advice->is_good();
  display.can_drop = is_free && !job.taken.empty();
  display.can_calibrate = is_free && job.taken.size() >= fewest;
  if (job.summary != nullptr) judge_result(job, context, display);
  display.band = band_of(status, display);

  if (job.is_calibrating) {
    display.next_text = "wait for the calibration";
  } else if (context.is_adopted) {
    display.next = CalibrateStep::Done;
    display.next_text = "go on to the tools";
  } else if (display.can_adopt && context.result_stands_s < kReading_s) {
    display.next_text = "read the result";
  } else if (display.can_adopt) {
    display.next = CalibrateStep::Adopt;
    display.next_text = "adopt the calibration";
  } else if (job.summary != nullptr && display.is_live) {
    display.next = CalibrateStep::Resume;
    display.next_text = "take more pictures";
  } else if (is_enough && job.summary == nullptr) {
    display.next = CalibrateStep::Calibrate;
    display.next_text = "calibrate";
  } else if (display.is_live) {
    display.next = CalibrateStep::Take;
    display.next_text = job.taken.empty() ? "take the first picture" : "take another picture";
  } else {
    const bool is_coming = status.phase == FeedPhase::Starting || status.awaits_still || !display.has_picture;
    display.next_text =
        is_coming && status.phase != FeedPhase::Failed ? "wait for the picture" : "choose another source";
  }
  return display;
}

}  // namespace arthronaut::setup
