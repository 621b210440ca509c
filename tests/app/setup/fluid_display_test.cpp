#include "app/setup/fluid_display.h"

#include <gtest/gtest.h>

#include "navigation/camera/medium.h"

namespace arthronaut::setup {
namespace {

using calibration::FluidHypothesis;
using widgets::Severity;

constexpr double kNow_s = 100;

FluidRunStatus running() {
  FluidRunStatus status;
  status.phase = FeedPhase::Running;
  status.looked_s = kNow_s - 0.1;
  status.job.picture = std::make_shared<camera::Frame>();
  status.job.refractive_index = camera::kSalineIndex;
  status.job.look.is_taken = true;
  status.job.seconds = 2.5;
  return status;
}

FluidRunStatus checked(std::vector<std::string> reasons) {
  FluidRunStatus status = running();
  auto summary = std::make_shared<calibration::FluidCheckSummary>();
  summary->rows = {{FluidHypothesis::FlatPort, 0.2, 0.03, 0.2, 0.09, 0.5},
                   {FluidHypothesis::NoRefraction, 1.4, 0.4, 2.0, -1, -1}};
  summary->reasons = std::move(reasons);
  status.job.summary = summary;
  return status;
}

// Half the five seconds are half the bar; a frame that does not count says why.
TEST(FluidDisplay, ShowsHowFarItIs) {
  FluidRunStatus status = running();
  EXPECT_DOUBLE_EQ(fluid_display(status, kNow_s).progress, 0.5);
  EXPECT_EQ(fluid_display(status, kNow_s).band.severity, Severity::Good);
  status.job.look.is_taken = false;
  status.job.look.reason = "marker 6 is not seen";
  EXPECT_EQ(fluid_display(status, kNow_s).band.severity, Severity::Caution);
  EXPECT_EQ(fluid_display(status, kNow_s).band.detail, "Not counted: marker 6 is not seen");
}

// The models stand in their order, best first; what was not measured is no number.
TEST(FluidDisplay, ListsTheModelsBestFirst) {
  const FluidDisplay display = fluid_display(checked({}), kNow_s);
  ASSERT_EQ(display.models.size(), 2U);
  EXPECT_EQ(display.models[0].name, "flat port");
  EXPECT_EQ(display.models[0].severity, Severity::Good);
  EXPECT_EQ(display.models[0].corners, "0.20 px");
  EXPECT_EQ(display.models[1].worst, "\u2013");
  EXPECT_EQ(display.verdict.severity, Severity::Good);
  EXPECT_EQ(display.next, FluidStep::Done);
}

// A check that fails says so by sign and word, with every reason.
TEST(FluidDisplay, RefusesWithReasons) {
  const FluidDisplay display = fluid_display(checked({"air fits better", "few pictures"}), kNow_s);
  EXPECT_EQ(display.verdict.severity, Severity::Bad);
  EXPECT_EQ(display.verdict.detail, "air fits better");
  EXPECT_EQ(display.reasons.size(), 2U);
  EXPECT_EQ(display.next, FluidStep::Again);
  EXPECT_EQ(display.models[0].severity, Severity::Caution);
}

// A source that ends early can be checked with what there is; one that shows no ruler can't.
TEST(FluidDisplay, ChecksWithWhatThereIs) {
  FluidRunStatus status = running();
  status.phase = FeedPhase::Ended;
  EXPECT_EQ(fluid_display(status, kNow_s).next, FluidStep::Again);
  status.job.sighting_count = 30;
  EXPECT_EQ(fluid_display(status, kNow_s).next, FluidStep::Check);
}

}  // namespace
}  // namespace arthronaut::setup
