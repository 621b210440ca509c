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

// Where the guide stood before the pictures stayed away tells nothing of what was drilled since.
TEST_F(DrillingTest, Hazard29SaidWithoutAPictureItRestsOnNoPose) {
  see_guide();
  const auto entry = drilling_.say_drilled(plan_, nullptr, 29);
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->kind, JournalKind::DrilledByWord);
  EXPECT_FALSE(entry->achieved);
  EXPECT_EQ(entry->text, "femur: no picture showed anything when it was said");
  EXPECT_EQ(drilling_.state().outcome, DrilledState::Outcome::NoEvidence);
  EXPECT_EQ(drilling_.state().evidence, guidance::EvidenceOutcome::NoPicture);
  // A pause of the source is no silence; nor is what was seen gone.
  ASSERT_TRUE(drilling_.say_drilled(plan_, nullptr, 0.5));
  EXPECT_TRUE(has_said());
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
  ASSERT_TRUE(drilling_.take_back(plan_));
  EXPECT_FALSE(has_seen() || has_said());
  EXPECT_TRUE(drilling_.state().was_taken_back);
  EXPECT_FALSE(drilling_.take_back(plan_)) << "once";
}

// What a drill is about to leave is the bone that is operated on, beside the plan too.
TEST(DrilledBone, Hazard7ADrillBesideThePlanIsHeldAgainstTheBone) {
  const experiments::Trial trial = registration::phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  SourceSetup source = test::scripted_source();
  source.pipeline.tools.tracker = tools::OutsideTracker{"", 0.1, 0.1};
  const tools::Tool drill = test::scripted_drill();
  source.pipeline.tools.tools.push_back(drill);
  test::PhantomOperation run;
  run.start(source);
  run.apply(test::true_registration(trial, provenance_of(run.operation().setup(), source)));
  const tunnels::Tunnel plan = test::phantom_plan().tunnel;
  const Eigen::Vector3d along = plan.direction.normalized();
  const Eigen::Vector3d tip_mm = plan.entry_mm + 10 * along + 7 * along.unitOrthogonal();
  geometry::RigidTransform bone_from_drill;
  bone_from_drill.rotation = Eigen::Quaterniond::FromTwoVectors(drill.axis->direction, along);
  bone_from_drill.translation_mm = tip_mm - bone_from_drill.rotate(*drill.tip_mm);
  tracker::TrackerPoses poses;
  tracker::set_all(source.pipeline.tools, tracker::BodyState::NeverCame, poses);
  for (tracker::BodyPose* const body : {&poses.bodies.front(), &poses.bodies.back()})
    body->state = tracker::BodyState::Tracked;
  poses.bodies.back().tracker_from_body = run.in_force().registration->marker_from_bone * bone_from_drill;
  run.operation().process(test::plain_frame(0, 90), &poses);
  const auto& seen = run.operation().frame().guidance.drill;
  ASSERT_TRUE(seen);
  EXPECT_TRUE(seen->is_beside_plan());
  const auto exit_mm = guidance::to_exit_along(*run.operation().setup().surface, tip_mm, along);
  ASSERT_TRUE(exit_mm);
  EXPECT_NEAR(seen->to_exit_mm, *exit_mm, 1e-6);
}

}  // namespace
}  // namespace arthronaut::operation
