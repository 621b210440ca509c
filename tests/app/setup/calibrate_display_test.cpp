#include "app/setup/calibrate_display.h"

#include <gtest/gtest.h>

#include "tests/app/setup/row_of.h"

namespace arthronaut::setup {
namespace {

using calibration::CalibrationSummary;
using calibration::CaptureAdvice;
using test::row_of;
using widgets::Severity;

constexpr double kNow_s = 100;

CaptureAdvice good_advice() {
  CaptureAdvice advice;
  advice.picture.board.corners.resize(200);
  advice.picture.lens.circle_found = true;
  advice.picture.lens.mark = lens::MarkState::Found;
  advice.quality.corner_count = 200;
  advice.quality.coverage = 0.9;
  advice.quality.edge_width_px = 2.5;
  advice.quality.tilt_deg = 28;
  advice.wanted = "Hold still and take the picture";
  return advice;
}

// A source that runs and gave a good picture 0.1 s ago.
CalibrateRunStatus running(const CaptureAdvice& advice = good_advice()) {
  CalibrateRunStatus status;
  status.phase = FeedPhase::Running;
  status.looked_s = kNow_s - 0.1;
  status.job.picture = std::make_shared<camera::Frame>();
  status.job.advice = std::make_shared<CaptureAdvice>(advice);
  return status;
}

CalibrateRunStatus calibrated(CalibrationSummary::Outcome outcome, std::vector<std::string> reasons) {
  CaptureAdvice complete = good_advice();
  complete.is_complete = true;
  CalibrateRunStatus status = running(complete);
  status.job.taken = {"picture 1", "picture 2", "picture 3"};
  auto summary = std::make_shared<CalibrationSummary>();
  summary->outcome = outcome;
  summary->reasons = std::move(reasons);
  summary->record.calibration.focal_px = 580.25;
  summary->record.calibration.covariance = camera::CameraCovariance::Identity() * 0.0004;
  summary->rms_px = 0.2;
  status.job.summary = summary;
  return status;
}

// A good picture that is of now may be taken, and the step says so.
TEST(CalibrateDisplay, OffersAGoodPicture) {
  const CalibrateDisplay display = calibrate_display(running(), {}, kNow_s);
  EXPECT_TRUE(display.is_live && display.can_take);
  EXPECT_FALSE(display.can_calibrate || display.can_adopt || display.can_drop);
  EXPECT_EQ(display.next, CalibrateStep::Take);
  EXPECT_EQ(display.band.severity, Severity::Good);
  EXPECT_EQ(row_of(display.quality, "Coverage").severity, Severity::Good);
}

// What the guide rejects can't be taken; every reason stands on the screen, the measure beside its limit.
TEST(CalibrateDisplay, SaysEveryReasonOfARejection) {
  CaptureAdvice advice = good_advice();
  advice.quality.coverage = 0.3;
  advice.rejections = {"the board covers 30 % of the view (needs 60 %)",
                       "it moves: 4.0 px since the last look"};
  advice.wanted = "Not yet: " + advice.rejections.front();
  const CalibrateDisplay display = calibrate_display(running(advice), {}, kNow_s);
  EXPECT_FALSE(display.can_take);
  EXPECT_EQ(display.band.severity, Severity::Caution);
  const std::string said = display.band.headline + display.band.detail;
  for (const std::string& reason : advice.rejections)
    EXPECT_NE(said.find(reason), std::string::npos) << reason;
  EXPECT_EQ(row_of(display.quality, "Coverage").severity, Severity::Caution);
  EXPECT_NE(row_of(display.quality, "Coverage").text.find("60 %"), std::string::npos);
}

// A source that hangs, fails or ends leaves no picture standing as live; its words are on the screen.
TEST(CalibrateDisplay, OldPicturesAreNotLive) {
  CalibrateRunStatus hanging = running();
  hanging.looked_s = kNow_s - 5;
  const CalibrateDisplay hung = calibrate_display(hanging, {}, kNow_s);
  EXPECT_FALSE(hung.is_live || hung.can_take);
  EXPECT_EQ(hung.band.headline, "No new picture");

  CalibrateRunStatus failing = running();
  failing.phase = FeedPhase::Failed;
  failing.message = "clip.mkv: frame 12 is cut off";
  const CalibrateDisplay failed = calibrate_display(failing, {}, kNow_s);
  EXPECT_FALSE(failed.is_live || failed.can_take);
  EXPECT_EQ(failed.band.severity, Severity::Bad);
  EXPECT_EQ(failed.band.detail, "clip.mkv: frame 12 is cut off");

  CalibrateRunStatus ending = running();
  ending.phase = FeedPhase::Ended;
  EXPECT_FALSE(calibrate_display(ending, {}, kNow_s).can_take);
}

// Enough pictures lead to the calibration, the calibration to its adoption, that to the next step.
TEST(CalibrateDisplay, LeadsToAdoption) {
  CaptureAdvice advice = good_advice();
  advice.is_complete = true;
  CalibrateRunStatus status = running(advice);
  status.job.taken = {"picture 1", "picture 2", "picture 3"};
  EXPECT_EQ(calibrate_display(status, {}, kNow_s).next, CalibrateStep::Calibrate);
  status.job.is_calibrating = true;
  EXPECT_EQ(calibrate_display(status, {}, kNow_s).next, CalibrateStep::Wait);

  const CalibrateRunStatus done = calibrated(CalibrationSummary::Outcome::Ok, {});
  const CalibrateDisplay display = calibrate_display(done, {}, kNow_s);
  EXPECT_TRUE(display.can_adopt);
  EXPECT_EQ(display.next, CalibrateStep::Adopt);
  EXPECT_EQ(display.verdict.severity, Severity::Good);
  EXPECT_EQ(calibrate_display(done, {.is_adopted = true}, kNow_s).next, CalibrateStep::Done);
  EXPECT_FALSE(calibrate_display(done, {.is_adopted = true}, kNow_s).can_adopt);
}

// A foot that bounces presses again before anybody has read the result: it adopts nothing. Whoever means it
// can take it at once.
TEST(CalibrateDisplay, APedalAdoptsOnlyWhatCouldBeRead) {
  const CalibrateRunStatus done = calibrated(CalibrationSummary::Outcome::Ok, {});
  const CalibrateDisplay fresh = calibrate_display(done, {.result_stands_s = 0.3}, kNow_s);
  EXPECT_EQ(fresh.next, CalibrateStep::Wait);
  EXPECT_EQ(fresh.next_text, "read the result");
  EXPECT_TRUE(fresh.can_adopt);
  EXPECT_EQ(calibrate_display(done, {.result_stands_s = kReading_s}, kNow_s).next, CalibrateStep::Adopt);
  // What was adopted already is not held up.
  EXPECT_EQ(calibrate_display(done, {.is_adopted = true, .result_stands_s = 0}, kNow_s).next,
            CalibrateStep::Done);
}

// A calibration that the module doubts can't be adopted, and every reason is said.
TEST(CalibrateDisplay, RefusesWhatIsUnreliable) {
  for (const auto outcome : {CalibrationSummary::Outcome::Unreliable, CalibrationSummary::Outcome::Failed,
                             CalibrationSummary::Outcome::NotRun}) {
    const CalibrateDisplay display =
        calibrate_display(calibrated(outcome, {"all boards face the lens", "another"}), {}, kNow_s);
    EXPECT_FALSE(display.can_adopt);
    EXPECT_EQ(display.verdict.severity, Severity::Bad);
    EXPECT_EQ(display.verdict.detail, "all boards face the lens");
    EXPECT_EQ(display.reasons.size(), 2U);
    EXPECT_EQ(display.next, CalibrateStep::Resume);
  }
  // A reason speaks against adoption whatever the outcome says.
  EXPECT_FALSE(calibrate_display(calibrated(CalibrationSummary::Outcome::Ok, {"a"}), {}, kNow_s).can_adopt);
}

// A calibration of the simulated arthroscope does not replace that of a real one.
TEST(CalibrateDisplay, KeepsWhatMayNotBeReplaced) {
  const CalibrateDisplay display = calibrate_display(calibrated(CalibrationSummary::Outcome::Ok, {}),
                                                     {.kept_because = "it is real"}, kNow_s);
  EXPECT_FALSE(display.can_adopt);
  EXPECT_EQ(display.verdict.detail, "it is real");
}

// An error is written with as many decimals as it needs: never as a nought.
TEST(CalibrateDisplay, WritesErrorsThatCanBeRead) {
  const CalibrateDisplay display =
      calibrate_display(calibrated(CalibrationSummary::Outcome::Ok, {}), {}, kNow_s);
  EXPECT_EQ(row_of(display.result, "Focal length").text, "580.25 \u00B1 0.02 px");
}

}  // namespace
}  // namespace arthronaut::setup
