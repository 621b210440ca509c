// What is known of the hole that is drilled, and what ends it.
#include "navigation/operation/drilling.h"

#include <gtest/gtest.h>

#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

// A hole of the phantom's plan, with the guide where it must be while it is drilled.
class DrillingTest : public ::testing::Test {
 protected:
  void SetUp() override { drilling_.on_source(plan_); }
  void see_guide() {
    guidance::GuidanceNumbers& numbers = frame_.guidance;
    numbers.state = guidance::GuidanceState::Valid;
    numbers.guide_direction = plan_->tunnel.direction;
    numbers.guide_point_mm = plan_->tunnel.entry_mm;
    for (int i = 0; i < 60; ++i) show();
  }
  void show() {
    frame_.guidance.timestamp_ns = frame_.timestamp_ns += 1'000'000'000 / 60;
    drilling_.add(frame_.guidance, frame_.timestamp_ns);
  }
  // Read, seen, said, and then read and seen of it once more.
  void fill() {
    drilling_.read_depth_stop(24);
    see_guide();
    ASSERT_TRUE(drilling_.say_drilled(plan_, nullptr));
    drilling_.read_depth_stop(25);
    see_guide();
    ASSERT_TRUE(has_read() && has_seen() && has_said());
  }
  [[nodiscard]] bool has_read() const { return drilling_.depth_stop_mm().has_value(); }
  [[nodiscard]] bool has_seen() const { return drilling_.state().has_evidence; }
  [[nodiscard]] bool has_said() const { return drilling_.state().outcome == DrilledState::Outcome::Recorded; }
  std::optional<PlannedTunnel> plan_ = test::phantom_plan();
  Drilling drilling_;
  pipeline::FrameResult frame_;
};

TEST_F(DrillingTest, WithAnotherPlanNothingIsLeft) {
  fill();
  drilling_.on_plan(plan_);
  EXPECT_FALSE(has_read() || has_seen() || has_said());
}

// The hole is the same one: what was read of it stays.
TEST_F(DrillingTest, WithAnotherSourceTheReadingIsLeft) {
  fill();
  drilling_.on_source(plan_);
  EXPECT_TRUE(has_read());
  EXPECT_FALSE(has_seen() || has_said());
}

TEST_F(DrillingTest, WithAnotherRegistrationWhatWasSeenGoes) {
  fill();
  drilling_.on_registration();
  EXPECT_TRUE(has_read() && has_said());
  EXPECT_FALSE(has_seen());
  ASSERT_FALSE(drilling_.say_drilled(plan_, nullptr)) << "what is recorded stays as it is";
  EXPECT_TRUE(has_said());
}

TEST_F(DrillingTest, WithAMarkerPlacedAnewWordAndReadingGo) {
  fill();
  drilling_.on_marker_placed_anew();
  drilling_.on_registration();  // the one of before is gone
  EXPECT_FALSE(has_read() || has_seen() || has_said());
}

// Until the medium was told to be the wrong one, it was the wrong one too.
TEST_F(DrillingTest, ThroughTheWrongMediumNothingWasSeen) {
  fill();
  frame_.guidance.state = guidance::GuidanceState::WrongMedium;
  show();
  EXPECT_FALSE(has_seen());
  EXPECT_TRUE(has_read() && has_said());
}

TEST_F(DrillingTest, AReadingIsOfOneHole) {
  drilling_.read_depth_stop(24);
  see_guide();
  const auto entry = drilling_.say_drilled(plan_, nullptr);
  ASSERT_TRUE(entry && entry->achieved);
  EXPECT_EQ(entry->achieved->depth_mm, 24);
  EXPECT_FALSE(has_read());
}

TEST_F(DrillingTest, TakenBackItRestsOnWhatIsSeenFromThenOn) {
  fill();
  ASSERT_TRUE(drilling_.take_back(true));
  EXPECT_FALSE(has_seen() || has_said());
  EXPECT_TRUE(drilling_.state().was_taken_back);
  EXPECT_FALSE(drilling_.take_back(true)) << "once";
}

}  // namespace
}  // namespace arthronaut::operation
