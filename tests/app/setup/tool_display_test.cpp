#include "app/setup/tool_display.h"

#include <gtest/gtest.h>

#include "tests/app/setup/row_of.h"

namespace arthronaut::setup {
namespace {

using test::row_of;
using tools::PivotCalibrationSummary;
using widgets::Severity;

constexpr double kNow_s = 100;
const ToolChoice kProbe{"probe", ToolTask::Tip};

// Both markers are seen, 40 poses were taken.
ToolRunStatus running() {
  ToolRunStatus status;
  status.phase = FeedPhase::Running;
  status.looked_s = kNow_s - 0.1;
  status.job.picture = std::make_shared<camera::Frame>();
  status.job.markers = {{"probe", true, "tracked"}, {"femur marker", true, "tracked"}};
  status.job.pose_count = 40;
  return status;
}

ToolRunStatus with_tip(PivotCalibrationSummary::Outcome outcome, std::vector<std::string> reasons) {
  ToolRunStatus status = running();
  auto result = std::make_shared<ToolResult>();
  result->tip.outcome = outcome;
  result->tip.reasons = std::move(reasons);
  result->tip.cone_deg = outcome == PivotCalibrationSummary::Outcome::Ok ? 24 : 9;
  result->tip.rms_mm = 0.05;
  result->tip.sigma_mm = 0.02;
  status.job.result = result;
  return status;
}

// A picture that does not count says why, and which marker is missing.
TEST(ToolDisplay, SaysWhyAPictureDoesNotCount) {
  ToolRunStatus status = running();
  status.job.markers[1] = {"femur marker", false, "glare"};
  status.job.reason = "no world marker is seen well beside it";
  const ToolDisplay display = tool_display(status, kProbe, {}, kNow_s);
  EXPECT_EQ(display.band.severity, Severity::Caution);
  EXPECT_NE(display.band.detail.find("no world marker"), std::string::npos);
  EXPECT_EQ(row_of(display.markers, "probe").severity, Severity::Good);
  EXPECT_EQ(row_of(display.markers, "femur marker").severity, Severity::Caution);
  EXPECT_EQ(row_of(display.markers, "femur marker").text, "glare");
}

// A narrow cone can't be adopted however small its residual; the limit stands beside the number.
TEST(ToolDisplay, RefusesANarrowCone) {
  const ToolRunStatus narrow =
      with_tip(PivotCalibrationSummary::Outcome::ConeTooNarrow, {"the cone is 9 degrees (needs 20)"});
  const ToolDisplay display = tool_display(narrow, kProbe, {}, kNow_s);
  EXPECT_FALSE(display.can_adopt);
  EXPECT_EQ(display.verdict.detail, "the cone is 9 degrees (needs 20)");
  EXPECT_EQ(row_of(display.numbers, "Cone").severity, Severity::Caution);
  EXPECT_EQ(row_of(display.numbers, "Residual").severity, Severity::Good);
  EXPECT_THROW((void)row_of(display.numbers, "Tip from the marker"), std::runtime_error);
  // While the tool still moves it is "not yet"; once the pictures have ended it is a refusal.
  EXPECT_EQ(display.verdict.severity, Severity::Caution);
  ToolRunStatus over = narrow;
  over.phase = FeedPhase::Ended;
  EXPECT_EQ(tool_display(over, kProbe, {}, kNow_s).verdict.severity, Severity::Bad);
  EXPECT_EQ(tool_display(over, kProbe, {}, kNow_s).next, ToolStep::Again);
}

// A good tip leads to its adoption, that to the next step.
TEST(ToolDisplay, LeadsToAdoption) {
  const ToolRunStatus good = with_tip(PivotCalibrationSummary::Outcome::Ok, {});
  const ToolDisplay display = tool_display(good, kProbe, {}, kNow_s);
  EXPECT_TRUE(display.can_adopt);
  EXPECT_EQ(display.next, ToolStep::Adopt);
  EXPECT_EQ(tool_display(good, kProbe, {.is_adopted = true}, kNow_s).next, ToolStep::Done);
}

// The pedal adopts what could be read, also where the pictures have ended meanwhile; then it goes on to what
// nobody measured yet.
TEST(ToolDisplay, APedalAdoptsOnlyWhatCouldBeRead) {
  ToolRunStatus good = with_tip(PivotCalibrationSummary::Outcome::Ok, {});
  for (const FeedPhase phase : {FeedPhase::Running, FeedPhase::Ended}) {
    good.phase = phase;
    const ToolDisplay fresh = tool_display(good, kProbe, {.result_stands_s = 0.3}, kNow_s);
    EXPECT_EQ(fresh.next, ToolStep::Wait);
    EXPECT_EQ(fresh.next_text, "read the result");
    EXPECT_TRUE(fresh.can_adopt);
    EXPECT_EQ(tool_display(good, kProbe, {.result_stands_s = kReading_s}, kNow_s).next, ToolStep::Adopt);
  }
}

TEST(ToolDisplay, GoesOnToWhatNobodyMeasured) {
  const ToolRunStatus good = with_tip(PivotCalibrationSummary::Outcome::Ok, {});
  EXPECT_EQ(tool_display(good, kProbe, {.is_adopted = true}, kNow_s).next_text, "go on to the fluid check");
  EXPECT_EQ(
      tool_display(good, kProbe, {.is_adopted = true, .next_tool = "femoral guide: axis"}, kNow_s).next_text,
      "go on to the femoral guide: axis");
}

// A simulated tip does not replace what a case knows of real tools.
TEST(ToolDisplay, KeepsWhatMayNotBeReplaced) {
  const ToolRunStatus good = with_tip(PivotCalibrationSummary::Outcome::Ok, {});
  const ToolDisplay display = tool_display(good, kProbe, {.kept_because = "it is real"}, kNow_s);
  EXPECT_FALSE(display.can_adopt);
  EXPECT_EQ(display.verdict.detail, "it is real");
}

// The picture of a source that hangs is not live, and no marker of it counts as seen.
TEST(ToolDisplay, OldPicturesAreNotLive) {
  ToolRunStatus status = running();
  status.looked_s = kNow_s - 5;
  const ToolDisplay display = tool_display(status, kProbe, {}, kNow_s);
  EXPECT_FALSE(display.is_live);
  EXPECT_EQ(display.band.severity, Severity::Bad);
  EXPECT_EQ(row_of(display.markers, "probe").severity, Severity::Quiet);
}

// Tips are offered of tools that have one or nothing, axes of guides; a result takes the place of what was
// known.
TEST(ToolChoices, FollowTheToolsFile) {
  const tools::ToolSet standard = tools::standard_tools();
  const auto choices = choices_of(standard);
  ASSERT_EQ(choices.size(), 3U);
  EXPECT_EQ(choices[0].task, ToolTask::Tip);
  EXPECT_EQ(choices[1].task, ToolTask::Axis);
  ToolResult result;
  result.tip.tip_in_tool_mm = {1, 2, 3};
  result.tip.rms_mm = 0.07;
  const provenance::Provenance measured{provenance::Origin::Measured, "2026-11-21T10:00:00Z"};
  const tools::ToolSet changed = with_result(standard, "probe", result, measured);
  EXPECT_EQ(*changed.find_tool("probe")->tip_mm, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(changed.find_tool("probe")->residual_mm, 0.07);
  EXPECT_EQ(changed.find_tool("probe")->provenance, measured);
  EXPECT_FALSE(changed.find_tool("femoral guide")->residual_mm.has_value());
  EXPECT_EQ(changed.find_tool("femoral guide")->provenance.origin, provenance::Origin::Nominal);
}

// What was measured carries how well it is known. A spin tells the line of the axis, not where on it the
// guide ends: the distal end stays as far along as it was declared, and the direction's error comes on top
// there.
TEST(ToolChoices, Hazard6AnAdoptedAxisKeepsItsEndAndItsError) {
  ToolResult result;
  result.task = ToolTask::Axis;
  result.axis.axis_point_in_tool_mm = {0.2, 0, -3.1};
  result.axis.axis_direction_in_tool = -Eigen::Vector3d::UnitY();
  result.axis.point_sigma_mm = 0.03;
  result.axis.direction_sigma_deg = 0.1;
  const tools::ToolSet changed = with_result(tools::standard_tools(), "femoral guide", result,
                                             {provenance::Origin::Measured, "2026-11-21T10:00:00Z"});
  const tools::Tool& guide = *changed.find_tool("femoral guide");
  EXPECT_LT((guide.axis->point_mm - Eigen::Vector3d(0.2, -24, -3.1)).norm(), 1e-12);
  EXPECT_EQ(guide.axis_direction_sigma_deg, 0.1);
  EXPECT_NEAR(*guide.axis_point_sigma_mm, std::hypot(0.03, 24 * geometry::rad_from_deg(0.1)), 1e-12);
  EXPECT_EQ(guide.nominal, tools::NominalParts{.end = true}) << "turning does not tell where it ends";
}

// What was not measured stays nominal, and is taken to be known no better than a drawing.
TEST(ToolChoices, Hazard6MeasuringTheTipSaysNothingOfTheAxis) {
  tools::ToolSet set = tools::standard_tools();
  set.tools.push_back({"drill", 7, 4.0, Eigen::Vector3d(0, -60, 0), tools::ToolAxis{{0, -60, 0}}});
  set.tools.back().kind = tools::ToolKind::Drill;
  const tools::Tool drawn = set.tools.back();
  const provenance::Provenance measured{provenance::Origin::Measured, "2026-11-21T10:00:00Z"};
  ToolResult tip, axis;
  tip.tip.rms_mm = 0.05;
  tip.tip.tip_in_tool_mm = {0, -60, 0};
  axis.task = ToolTask::Axis;
  axis.axis.axis_direction_in_tool = -Eigen::Vector3d::UnitY();
  axis.axis.rms_mm = 0.05;

  const tools::ToolSet with_tip = with_result(set, "drill", tip, measured);
  EXPECT_EQ(with_tip.tools.back().nominal, (tools::NominalParts{.axis = true, .end = true}));
  EXPECT_EQ(tools::axis_error(with_tip.tools.back()).direction_sigma_rad,
            tools::axis_error(drawn).direction_sigma_rad);
  const tools::ToolSet with_axis = with_result(set, "drill", axis, measured);
  EXPECT_EQ(with_axis.tools.back().nominal, (tools::NominalParts{.tip = true, .end = true}));
  EXPECT_EQ(tools::tip_error_mm2(with_axis.tools.back()), tools::tip_error_mm2(drawn));
  const tools::ToolSet with_both = with_result(with_tip, "drill", axis, measured);
  EXPECT_EQ(with_both.tools.back().nominal, tools::NominalParts{.end = true});
}

}  // namespace
}  // namespace arthronaut::setup
