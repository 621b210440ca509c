#include "app/navigate/tracking_words.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace arthronaut::navigate {
namespace {

using widgets::Severity;
using Phase = theatre::LiveState::Phase;

// A camera that is recorded, 20 ms ago its newest picture.
struct Recorded {
  theatre::LiveState live;
  double now_s = 100;

  Recorded() {
    auto source = std::make_shared<operation::SourceSetup>();
    source->kind = sources::SourceKind::Live;
    auto operation = std::make_shared<operation::OperationState>();
    operation->has_source = true;
    operation->source = source;
    operation->frame.processing_ms = 12;
    live.operation = operation;
    live.phase = Phase::Running;
    live.picture = std::make_shared<camera::Frame>();
    live.captured_s = now_s - 0.02;
    live.stale_after_s = 0.1;
    live.frames_per_second = 30;
    live.session_folder = "0001-20260131-120000";
  }
  [[nodiscard]] std::vector<SeverityText> rows() const { return record_rows(live, display_of(&live, now_s)); }
};

TEST(RecordRows, SayWhatIsKeptAndHowFastPicturesCome) {
  Recorded recorded;
  auto rows = recorded.rows();
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].text, "journal");
  EXPECT_EQ(rows[1].text, "30 pictures/s, 12 ms each, 20 ms old");
  recorded.live.keeps_video = true;
  rows = recorded.rows();
  EXPECT_EQ(rows[0].text, "video and journal");
  EXPECT_EQ(rows[0].severity, Severity::Good);
}

// A source that has ended or failed has no rate and no age, and nothing of it is recorded any more.
TEST(RecordRows, Hazard3ADeadSourceHasNoFigures) {
  for (const Phase phase : {Phase::Ended, Phase::Failed}) {
    Recorded recorded;
    recorded.live.phase = phase;
    const auto rows = recorded.rows();
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].name, "Recording");
    EXPECT_EQ(rows[0].text, "ended");
    EXPECT_EQ(rows[0].severity, Severity::Quiet);
  }
}

// A camera that gives no pictures for a while is still recorded, and has no rate.
TEST(RecordRows, Hazard3ASilentSourceHasNoRate) {
  Recorded recorded;
  recorded.live.keeps_video = true;
  recorded.now_s += 5;
  const auto rows = recorded.rows();
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].text, "video and journal; no pictures come");
  EXPECT_EQ(rows[0].severity, Severity::Quiet);
}

TEST(RecordRows, Hazard13SayWhyNothingIsRecorded) {
  Recorded recorded;
  recorded.live.record_trouble = "the disk is full";
  EXPECT_EQ(recorded.rows()[0].severity, Severity::Bad);
  EXPECT_EQ(recorded.rows()[0].text, "the disk is full");
  recorded.live.record_trouble.clear();
  recorded.live.session_folder.clear();
  EXPECT_EQ(recorded.rows()[0].name, "Nothing is recorded");
}

// Of what a time-out reads out the panel shows plan and medium, with the knee that they are of.
TEST(BeginningRows, ShowPlanKneeAndMedium) {
  auto source = std::make_shared<operation::SourceSetup>();
  source->pipeline.side = bones::Side::Left;
  source->pipeline.refractive_index = 1.3345;
  operation::OperationState state;
  state.source = source;
  state.bone = bones::BoneKind::Tibia;
  state.depth_stop_mm = 21.5;
  const auto rows = beginning_rows(state, "Muster, Anna");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].name, "Plan, left, tibia");
  EXPECT_EQ(rows[0].text, "none");
  EXPECT_EQ(rows[1].name, "Medium");
  EXPECT_EQ(rows[1].text, "saline");
  EXPECT_EQ(rows[2].text, "21.5 mm, as read");
}

// Why a touch was refused is told while it can be mended: not for good when the source has ended, whose time
// stands still then.
TEST(TouchNotice, EndsWithTheSource) {
  operation::OperationState state;
  state.has_source = true;
  state.touch_refusal = operation::TouchRefusal::TipMoves;
  EXPECT_FALSE(touch_notice(state).empty());
  state.has_source = false;
  EXPECT_TRUE(touch_notice(state).empty());
  state.touch_refusal = operation::TouchRefusal::NoSource;
  EXPECT_EQ(touch_notice(state), "no pictures come");
}

}  // namespace
}  // namespace arthronaut::navigate
