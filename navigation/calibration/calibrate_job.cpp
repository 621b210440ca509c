#include "navigation/calibration/calibrate_job.h"

#include <utility>

#include "navigation/calibration/residual_plot.h"
#include "planning/geometry/error.h"

namespace arthronaut::calibration {

namespace {

// Good in so many looks, one after the other: held still and not a chance hit.
constexpr int kGoodLooks = 2;
// A still that is not good stands so long that the reason can be read.
constexpr int kLooksAtBadStill = 10;

}  // namespace

void CalibrateJob::look(const camera::FramePtr& frame) {
  if (frame != picture_) {
    looks_at_this_ = 0;
    took_this_ = false;
  }
  picture_ = frame;
  ++looks_at_this_;
  camera::gray_from(*frame, gray_);
  const CaptureAdvice& advice = guide_.look({gray_.data(), frame->width, frame->height, frame->width});
  good_looks_ = advice.is_good() ? good_looks_ + 1 : 0;
  const bool may_take = takes_by_itself_ && !is_calibrating_ && summary_ == nullptr;
  if (may_take && good_looks_ >= kGoodLooks) take();
}

bool CalibrateJob::wants_next_still() const {
  if (took_this_) return true;
  return takes_by_itself_ && summary_ == nullptr && looks_at_this_ >= kLooksAtBadStill;
}

void CalibrateJob::take() {
  if (picture_ == nullptr || !guide_.advice().picture.board.found()) {
    note_ = "Not taken: no checkerboard is seen";
    return;
  }
  if (!guide_.advice().is_good()) {
    note_ = "Not taken: " + guide_.advice().rejections.front();
    return;
  }
  guide_.take();
  forget_result();
  took_this_ = true;
  good_looks_ = 0;
}

void CalibrateJob::drop_last() {
  guide_.drop_last();
  took_this_ = false;
  forget_result();
}

void CalibrateJob::forget_result() {
  note_.clear();
  summary_.reset();
  residuals_.reset();
}

void CalibrateJob::calibrate(const CalibrationOptions& options) {
  forget_result();
  options_ = options;
  is_calibrating_ = true;
}

bool CalibrateJob::work() {
  if (!std::exchange(is_calibrating_, false)) return false;
  CalibrationSummary summary;
  try {  // pictures that can't be calibrated from are an outcome here: others can be taken
    summary = calibration::calibrate(guide_.taken(), options_);
  } catch (const InvalidInput& error) {
    summary.outcome = CalibrationSummary::Outcome::Failed;
    summary.reasons = {error.what()};
  }
  if (summary.is_usable())
    residuals_ = std::make_shared<const camera::Frame>(draw_residuals(summary, guide_.taken()));
  summary_ = std::make_shared<const CalibrationSummary>(std::move(summary));
  return true;
}

CalibrateStatus CalibrateJob::status() const {
  CalibrateStatus status;
  status.picture = picture_;
  if (picture_ != nullptr) status.advice = std::make_shared<const CaptureAdvice>(guide_.advice());
  for (const CalibrationPicture& picture : guide_.taken()) {
    status.taken.push_back(picture.name);
    status.taken_angles_deg.push_back(picture.lens.mark_angle_deg);
  }
  status.takes_by_itself = takes_by_itself_;
  status.note = note_;
  status.took_this = took_this_;
  status.is_calibrating = is_calibrating_;
  status.summary = summary_;
  status.residuals = residuals_;
  return status;
}

}  // namespace arthronaut::calibration
