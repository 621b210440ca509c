#include "navigation/training/exercise_facts.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::training {
namespace {

using Eigen::Vector3d;
using geometry::RigidTransform;

constexpr double kLength_mm = 30;

// A trainee and an operation, frame by frame, made by hand.
class ExaminerTest : public ::testing::Test {
 protected:
  ExaminerTest() {
    plan_.entry_mm = {10, 0, 0};
    plan_.direction = {0, 0, 1};
    auto source = std::make_shared<operation::SourceSetup>();
    source->pipeline.tools = tools::standard_tools();
    state_.source = source;
    state_.frame.tools.resize(source->pipeline.tools.tools.size());
    for (auto& tool : state_.frame.tools) tool.world_from_tool.is_valid = true;
    state_.frame.guidance.state = guidance::GuidanceState::Valid;
    truth_.hand.held = simulator::Held::Guide;
    truth_.hand.guide_point_mm = {11, 0, -2};
    truth_.hand.guide_direction = {0, 0, 1};
    guide_by({});
  }
  // The operation believes in this registration; the truth is that the bone's frame is the marker's.
  void guide_by(const RigidTransform& marker_from_bone, bool alarm = false) {
    auto registration = std::make_shared<registration::RegistrationSummary>();
    registration->has_pose = registration->reliable = true;
    registration->marker_from_bone = marker_from_bone;
    auto known = std::make_shared<operation::RegistrationState>();
    known->in_force.registration = registration;
    known->in_force.standing = operation::Standing::Stands;
    if (alarm) known->alarm.kind = operation::TouchAlarm::Kind::ControlPointMoved;
    state_.registration = known;
  }
  // Frames of a thirtieth of a second, in which the drill goes on by so much each.
  void go_on(int frames, double drilled_mm = 0) {
    for (int i = 0; i < frames; ++i) {
      truth_.time_s += 1.0 / 30;
      truth_.hand.drilled_depth_mm += drilled_mm;
      examiner_.add(state_, truth_);
    }
  }
  tunnels::Tunnel plan_;
  operation::OperationState state_;
  simulator::HandTruth truth_;
  Examiner examiner_{
      *find_exercise("drill-femur"), {.entry_mm = {10, 0, 0}, .direction = {0, 0, 1}}, kLength_mm, {0, 0, 0}};
};

// The tunnel is where the guide truly stood, and as deep as the drill truly went.
TEST_F(ExaminerTest, MeasuresTheTunnelByTheTruth) {
  truth_.hand.guide_direction = Vector3d(0, std::sin(0.05), std::cos(0.05));
  go_on(3);
  EXPECT_FALSE(examiner_.facts().entry_offset_mm.has_value());  // nothing is drilled yet
  go_on(32, 1);
  const ExerciseFacts facts = examiner_.facts();
  // The axis passes the entry's plane 1 mm beside it in x and 2 tan(0.05) in y.
  EXPECT_NEAR(*facts.entry_offset_mm, std::hypot(1, 2 * std::tan(0.05)), 1e-9);
  EXPECT_NEAR(*facts.angle_deg, geometry::deg_from_rad(0.05), 1e-9);
  EXPECT_NEAR(*facts.depth_error_mm, 2, 1e-9);
  EXPECT_EQ(facts.bad_data_mm, 0);
}

// A guide that lies across the plan is as far beside the entry as guidance says: by its axis, not by its end.
TEST_F(ExaminerTest, MeasuresAGuideAcrossThePlanAsGuidanceDoes) {
  truth_.hand.guide_direction = Vector3d(0, std::cos(0.02), std::sin(0.02));
  truth_.hand.guide_point_mm = {11, 5, 0};
  go_on(3, 1);
  ASSERT_TRUE(examiner_.facts().entry_offset_mm.has_value());
  const Vector3d crossing =
      guidance::crossing_of(truth_.hand.guide_point_mm, truth_.hand.guide_direction, plan_);
  EXPECT_NEAR(*examiner_.facts().entry_offset_mm, (crossing - plan_.entry_mm).norm(), 1e-9);
  EXPECT_LT(*examiner_.facts().entry_offset_mm, 2);
}

// To drill on while nothing guides is to act on bad data, by the millimetre.
TEST_F(ExaminerTest, CountsWhatIsDrilledWithoutGuidance) {
  go_on(5, 1);
  state_.frame.guidance.state = guidance::GuidanceState::WorldMarkerLost;
  go_on(4, 1);
  go_on(10);
  EXPECT_NEAR(examiner_.facts().bad_data_mm, 4, 1e-9);
}

// So is it while the numbers are there and wrong: nobody looked whether the marker had moved.
TEST_F(ExaminerTest, CountsWhatIsDrilledByAWrongRegistration) {
  go_on(2);
  truth_.marker_from_bone.translation_mm = {2.5, 0, 0};
  truth_.faults = 1U << static_cast<unsigned>(simulator::FaultKind::BumpedMarker);
  go_on(6, 1);
  const ExerciseFacts facts = examiner_.facts();
  EXPECT_NEAR(facts.bad_data_mm, 6, 1e-9);
  EXPECT_NEAR(facts.worst_bad_error_mm, 2.5, 1e-9);
  EXPECT_NEAR(*facts.tunnel_error_mm, 2.5, 1e-9);
  EXPECT_TRUE(facts.marker_was_bumped);
}

// The numbers may be gone in the very picture in which the key is pressed; who has had none for longer has
// guessed.
TEST_F(ExaminerTest, AimingIsBlindAfterHalfASecondWithoutNumbers) {
  examiner_ = Examiner(*find_exercise("aim"), {.entry_mm = {10, 0, 0}, .direction = {0, 0, 1}}, kLength_mm,
                       {0, 0, 0});
  go_on(30);
  state_.frame.guidance.state = guidance::GuidanceState::WorldMarkerLost;
  go_on(2);
  Examiner after_two = examiner_;
  after_two.finish();
  EXPECT_EQ(after_two.facts().bad_data_mm, 0);
  go_on(20);
  examiner_.finish();
  EXPECT_GT(examiner_.facts().bad_data_mm, 2);
}

// A registration that the program refuses earns nothing, however exact it is; that it was wrong is still held
// against who drills by it.
TEST_F(ExaminerTest, ARegistrationThatDoesNotStandIsNone) {
  go_on(2);
  ASSERT_TRUE(examiner_.facts().tunnel_error_mm.has_value());
  for (const operation::Standing standing : {operation::Standing::NotReliable, operation::Standing::Void,
                                             operation::Standing::InDoubt, operation::Standing::Alarm}) {
    auto refused = std::make_shared<operation::RegistrationState>(*state_.registration);
    refused->in_force.standing = standing;
    state_.registration = refused;
    go_on(1);
    EXPECT_FALSE(examiner_.facts().tunnel_error_mm.has_value());
  }
  state_.frame.guidance.state = guidance::GuidanceState::RegistrationUnreliable;
  truth_.marker_from_bone.translation_mm = {2.5, 0, 0};
  go_on(3, 1);
  EXPECT_NEAR(examiner_.facts().bad_data_mm, 3, 1e-9);
  EXPECT_NEAR(examiner_.facts().worst_bad_error_mm, 2.5, 1e-9);
  guide_by({});
  go_on(1);
  EXPECT_TRUE(examiner_.facts().tunnel_error_mm.has_value());
}

// An alarm that is drilled through is ignored once, however long; one that ends with another registration is
// heeded; one that is waved away though the marker had moved is ignored.
TEST_F(ExaminerTest, TellsHeededAlarmsFromIgnoredOnes) {
  go_on(2);
  guide_by({}, true);
  go_on(8, 0.5);
  EXPECT_EQ(examiner_.facts().alarms, 1);
  EXPECT_EQ(examiner_.facts().alarms_ignored, 1);

  Examiner heeds(*find_exercise("drill-femur"), plan_, kLength_mm, {0, 0, 0}), waves = heeds;
  truth_.hand.drilled_depth_mm = 0;
  truth_.faults = 1U << static_cast<unsigned>(simulator::FaultKind::BumpedMarker);
  for (Examiner* const examiner : {&heeds, &waves}) {
    guide_by({});
    examiner->add(state_, truth_);
    guide_by({}, true);
    examiner->add(state_, truth_);
    auto after = std::make_shared<operation::RegistrationState>(*state_.registration);
    after->alarm = {};
    ++after->change_count;  // the end of the alarm changes what is in force, whatever ended it
    if (examiner == &heeds)
      after->history = std::make_shared<const std::vector<operation::RegistrationEntry>>(1);
    state_.registration = after;
    examiner->add(state_, truth_);
    EXPECT_EQ(examiner->facts().alarms, 1);
  }
  EXPECT_EQ(heeds.facts().alarms_ignored, 0);
  EXPECT_EQ(waves.facts().alarms_ignored, 1);
}

// What the operation took for a stroke counts by where the tip truly was.
TEST_F(ExaminerTest, TellsStrokesInTheAir) {
  truth_.hand.held = simulator::Held::Probe;
  const auto draw = [&](int frames, bool on_bone) {
    truth_.hand.touches_bone = on_bone;
    for (int i = 0; i < frames; ++i) {
      truth_.hand.probe_tip_mm.x() += 0.5;
      auto known = std::make_shared<operation::RegistrationState>(*state_.registration);
      ++known->point_count;
      state_.registration = known;
      go_on(1);
    }
  };
  go_on(1);
  draw(30, true);
  draw(10, false);
  truth_.hand.probe_tip_mm.x() += 50;  // not drawn: no new point
  go_on(1);
  EXPECT_NEAR(examiner_.facts().drawn_mm, 20, 1e-9);
  EXPECT_NEAR(examiner_.facts().drawn_in_air_mm, 5, 1e-9);
}

// A tool whose marker is not seen is out of view for as long; a refused touch was wasted.
TEST_F(ExaminerTest, CountsWhatIsOutOfViewAndWasted) {
  go_on(1);
  for (auto& tool : state_.frame.tools) tool.world_from_tool.is_valid = false;
  go_on(30);
  state_.touch_refusal = operation::TouchRefusal::TipUnknown;
  state_.touch_asked_ns = 5;
  go_on(3);
  EXPECT_NEAR(examiner_.facts().unseen_s, 1.1, 1e-6);
  EXPECT_EQ(examiner_.facts().wasted_touches, 1);
  EXPECT_EQ(examiner_.facts().touches, 1) << "of which it was one";
}

// Touches that were to verify one registration verify none of the next: what is missing is what the operation
// asks for.
TEST_F(ExaminerTest, AfterAnotherRegistrationTouchesAreMissingAnew) {
  const geometry::Surface bone(test::box({20, 20, 20}));
  const auto touch = [&](const std::function<void(operation::Touches&)>& change) {
    auto known = std::make_shared<operation::RegistrationState>(*state_.registration);
    change(known->touches);
    known->touches.judge(known->in_force.registration.get(), &bone, std::nullopt, {});
    state_.registration = known;
    go_on(1);
    return examiner_.facts().verifying_touches_missing;
  };
  const Vector3d on_bone = bone.closest_point({0, 0, 50}).point_mm;
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(touch([&](auto& touches) { touches.add_touch(on_bone + Vector3d(5.0 * i, 0, 0), {}); }), 2 - i);
  EXPECT_EQ(touch([](auto& touches) { touches.verify_anew(); }), 3);
}

// Verified is what touches have verified; skipped is as good as none.
TEST_F(ExaminerTest, SkippedVerificationIsNone) {
  state_.verification = operation::Verification::ByTouches;
  go_on(1);
  EXPECT_EQ(examiner_.facts().verifying_touches_missing, 0);
  state_.verification = operation::Verification::Skipped;
  go_on(1);
  EXPECT_EQ(examiner_.facts().verifying_touches_missing, 3);
}

}  // namespace
}  // namespace arthronaut::training
