// Strokes become a registration that guides, and what takes it away again.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

using registration::phantom_bone;
using test::PhantomOperation;

class RegistrationRules : public ::testing::Test {
 protected:
  void SetUp() override { run_.start(test::scripted_source()); }
  [[nodiscard]] Eigen::Vector3d on_bone(double dx_mm) const { return test::on_bone(trial_, dx_mm); }
  [[nodiscard]] double error_mm() {
    const Eigen::Vector3d target = phantom_bone().target_mm;
    return (run_.in_force().registration->marker_from_bone * target - trial_.marker_from_bone * target)
        .norm();
  }
  [[nodiscard]] strokes::Curves part(double from, double to) const {
    const auto at = [&](double share) {
      return trial_.curves.begin() +
             static_cast<std::ptrdiff_t>(share * static_cast<double>(trial_.curves.size()));
    };
    return {at(from), at(to)};
  }
  experiments::Trial trial_ = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  PhantomOperation run_;
};

// Nothing guides before it is confirmed; then it takes effect by itself, and stays in the history. The probe
// may draw on; the same source again does not draw over what stands.
TEST_F(RegistrationRules, AConfirmedRegistrationTakesEffectByItself) {
  EXPECT_EQ(run_.in_force().standing, Standing::None);
  run_.draw(trial_.curves);
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
  EXPECT_TRUE(run_.in_force().registration->reliable);
  const auto state = run_.state();
  EXPECT_EQ(state->registration->history->back().registration, state->registration->in_force.registration);
  EXPECT_EQ(state->registration->history->back().origin, RegistrationOrigin::WhileDrawing);
  EXPECT_LT(error_mm(), 0.6);
  EXPECT_GT(run_.count(JournalKind::RegistrationInForce), 0);
  EXPECT_TRUE(state->draws);
  run_.start(test::scripted_source());
  EXPECT_FALSE(run_.state()->draws);
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
}

// The first half of the strokes confirms; the rest is of a surface that is not this bone's, wavy by more than
// any tracker's error. What the first half found guides no more, with the reason: also when the surgeon had
// chosen it by hand.
TEST_F(RegistrationRules, DoubtRevokesGuidanceWhoeverChoseTheRegistration) {
  constexpr double kWave_mm = 1.0, kLength_mm = 9;
  run_.draw(part(0, 0.5));
  ASSERT_EQ(run_.in_force().standing, Standing::Stands);
  run_.apply(RegisterStrokes{});
  ASSERT_GE(run_.state()->registration->history->size(), 2U);
  run_.apply(ChooseRegistration{0});
  ASSERT_TRUE(run_.state()->registration->is_chosen);
  ASSERT_EQ(run_.in_force().standing, Standing::Stands);
  strokes::Curves other_bone = part(0.5, 1);
  for (strokes::CurvePoint& point : other_bone) {
    const Eigen::Vector3d phase = 2 * geometry::kPi / kLength_mm * point.position_mm;
    point.position_mm += kWave_mm * Eigen::Vector3d(phase.y(), phase.z(), phase.x()).array().sin().matrix();
  }
  run_.apply(Draw{true});
  run_.draw(other_bone);
  EXPECT_TRUE(run_.state()->registration->online->bone_is_in_doubt);
  EXPECT_EQ(run_.in_force().standing, Standing::InDoubt);
  EXPECT_FALSE(run_.in_force().registration->reliable);
  EXPECT_FALSE(run_.in_force().registration->reasons.empty());
}

// Touches on the bone that are not used in the fit verify it; one place touched three times does not.
TEST_F(RegistrationRules, TouchesVerify) {
  run_.draw(trial_.curves);
  for (int i = 0; i < 3; ++i) run_.touch(on_bone(0));
  EXPECT_FALSE(run_.in_force().is_verified);
  EXPECT_FALSE(run_.state()->registration->touches.last().is_new_place);
  for (const double dx_mm : {4.0, -4.0}) run_.touch(on_bone(dx_mm));
  EXPECT_TRUE(run_.in_force().is_verified);
  EXPECT_EQ(run_.state()->registration->touches.last().number, 5);
}

// The same strokes registered once more give the same: what is asked for is more of them.
TEST_F(RegistrationRules, WhatWasRefusedAsksForMoreStrokes) {
  strokes::Curves spot = trial_.curves;
  spot.resize(std::min<std::size_t>(spot.size(), 300));
  const Eigen::Vector3d place = spot.front().position_mm;
  for (std::size_t i = 0; i < spot.size(); ++i) {
    const double turn_rad = static_cast<double>(i);
    spot[i].curve = 0;
    spot[i].position_mm = place + 0.1 * Eigen::Vector3d(std::cos(turn_rad), std::sin(turn_rad), 0);
  }
  run_.draw(spot);
  run_.apply(Draw{false});
  ASSERT_EQ(run_.state()->next_action, NextAction::RegisterStrokes);
  run_.apply(RegisterStrokes{});
  ASSERT_EQ(run_.in_force().standing, Standing::NotReliable);
  EXPECT_EQ(run_.state()->next_action, NextAction::Draw);
  run_.apply(Draw{true});
  EXPECT_EQ(run_.state()->next_action, NextAction::GoOnDrawing);
  for (strokes::CurvePoint& point : spot) point.curve = 1;
  run_.draw(spot);
  run_.apply(Draw{false});
  EXPECT_EQ(run_.state()->next_action, NextAction::RegisterStrokes) << "there are new ones";
}

// Going back to an earlier registration holds against newer ones until the newest is chosen again.
TEST_F(RegistrationRules, AnEarlierRegistrationCanBeChosen) {
  run_.draw(trial_.curves);
  run_.apply(RegisterStrokes{});
  const std::size_t count = run_.state()->registration->history->size();
  ASSERT_GE(count, 2U);
  EXPECT_EQ(run_.state()->registration->entry_in_force, count - 1);
  run_.apply(ChooseRegistration{count - 2});
  EXPECT_TRUE(run_.state()->registration->is_chosen);
  EXPECT_EQ(run_.state()->registration->entry_in_force, count - 2);
  run_.apply(ChooseRegistration{count});
  EXPECT_EQ(run_.state()->registration->entry_in_force, count - 2) << "there is no such entry";
  run_.apply(ChooseRegistration{count - 1});
  EXPECT_FALSE(run_.state()->registration->is_chosen);
}

// Clearing while an alarm says that the marker has moved drops what was registered, for good.
TEST_F(RegistrationRules, ClearingAfterAnAlarmDropsTheRegistration) {
  run_.draw(trial_.curves);
  run_.touch(on_bone(0), TouchControlPoint{});
  for (int i = 0; i < 2; ++i) run_.touch(on_bone(0) + Eigen::Vector3d(0, 0, 2.4), TouchControlPoint{});
  ASSERT_EQ(run_.in_force().standing, Standing::Alarm);
  run_.apply(ClearStrokes{});
  EXPECT_EQ(run_.in_force().standing, Standing::None);
  const auto history = run_.state()->registration->history;
  ASSERT_FALSE(history->empty()) << "its numbers are kept";
  EXPECT_TRUE(history->back().marker_has_moved);
  run_.apply(ChooseRegistration{history->size() - 1});
  EXPECT_EQ(run_.in_force().standing, Standing::None) << "it can't be taken again";
}

// Without an alarm the registration stays; new strokes register anew.
TEST_F(RegistrationRules, ClearsAndStartsAgain) {
  run_.draw(trial_.curves);
  run_.apply(ClearStrokes{});
  EXPECT_TRUE(run_.operation().points().empty());
  EXPECT_EQ(run_.state()->registration->online, nullptr);
  EXPECT_EQ(run_.in_force().standing, Standing::Stands);
  const std::size_t entries = run_.state()->registration->history->size();
  run_.draw(trial_.curves);
  EXPECT_GT(run_.state()->registration->history->size(), entries);
  EXPECT_EQ(run_.state()->registration->entry_in_force, run_.state()->registration->history->size() - 1);
}

// What was found with strokes that are gone or excluded, before the registration heard of it, must never
// take effect: by a fit that was asked for, and by the one that runs along.
TEST_F(RegistrationRules, ARegistrationOfOldStrokesHasNoEffect) {
  const std::vector<Command> changes{ClearStrokes{}, TakeBackStroke{}, ExcludeStroke{0, true},
                                     SkipVerification{}};  // the last one changes nothing about strokes
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Operation operation(test::phantom_setup());
    RegistrationWork work([] { return phantom_bone().prepared; }, work_options(operation.setup()));
    operation.start_source(test::scripted_source());
    operation.apply(ConfirmTimeOut{});  // no stroke is taken before
    pipeline::FrameResult frame;
    frame.tip_is_valid = frame.camera_from_world.is_valid = true;
    int curve = 0;
    for (const strokes::CurvePoint& point : trial_.curves) {
      frame.timestamp_ns += point.curve == curve ? 16'666'667 : 1'000'000'000;
      curve = point.curve;
      frame.tip_in_world_mm = point.position_mm;
      operation.process_recorded(frame);
    }
    operation.apply(RegisterStrokes{});
    for (const RegistrationRequest& request : operation.take_requests()) (void)work.work_in(request);
    operation.apply(changes[i]);
    operation.take_outcome(work.outcome());
    const bool takes_effect = operation.state()->registration->in_force.standing == Standing::Stands;
    EXPECT_EQ(takes_effect, i + 1 == changes.size()) << name_of(changes[i]);
    EXPECT_FALSE(operation.state()->registration->is_fitting);
  }
}

// Strokes that were all drawn before the bone was ready are judged as those drawn live, and take effect:
// nobody draws on and nobody presses a key.
TEST_F(RegistrationRules, StrokesThatWereDrawnBeforeTheBoneWasReadyConfirm) {
  Operation operation(test::phantom_setup());
  operation.start_source(test::scripted_source());
  operation.apply(ConfirmTimeOut{});  // no stroke is taken before
  pipeline::FrameResult frame;
  frame.tip_is_valid = frame.camera_from_world.is_valid = true;
  int curve = 0;
  for (const strokes::CurvePoint& point : trial_.curves) {
    frame.timestamp_ns += point.curve == curve ? 16'666'667 : 1'000'000'000;
    curve = point.curve;
    frame.tip_in_world_mm = point.position_mm;
    operation.process_recorded(frame);
  }
  EXPECT_FALSE(operation.state()->registration->bone_is_ready);
  RegistrationWork work([] { return phantom_bone().prepared; }, work_options(operation.setup()));
  operation.take_outcome(work.outcome());
  for (const RegistrationRequest& request : operation.take_requests()) (void)work.work_in(request);
  operation.take_outcome(work.outcome());
  const auto state = operation.state();
  ASSERT_EQ(state->registration->in_force.standing, Standing::Stands);
  EXPECT_EQ(state->registration->in_force.registration->point_residuals_mm.size(), trial_.curves.size())
      << "every point has a say, to the last one";
}

// A bone that cannot be made ready says why, once and for all; nothing else fails, and nobody waits for a
// registration that can't come, whether it was asked for before or after.
TEST_F(RegistrationRules, ABoneThatFailsSaysWhy) {
  Operation operation(test::phantom_setup());
  RegistrationWork work([]() -> SurfaceIndexPtr { throw std::runtime_error("the mesh is empty"); },
                        work_options(operation.setup()));
  operation.start_source(test::scripted_source());
  operation.take_outcome(work.outcome());
  EXPECT_EQ(operation.state()->registration->bone_trouble, "the mesh is empty");
  pipeline::FrameResult frame;
  frame.tip_is_valid = frame.camera_from_world.is_valid = true;
  for (const strokes::CurvePoint& point : part(0, 0.1)) {
    frame.timestamp_ns += 16'666'667;
    frame.tip_in_world_mm = point.position_mm;
    operation.process_recorded(frame);
  }
  operation.apply(RegisterStrokes{});
  EXPECT_FALSE(operation.state()->registration->is_fitting) << "nobody would ever answer";
  for (const RegistrationRequest& request : operation.take_requests()) EXPECT_FALSE(work.work_in(request));
}

TEST_F(RegistrationRules, AFitThatWaitsForABoneThatFailsIsGivenUp) {
  Operation operation(test::phantom_setup());
  operation.start_source(test::scripted_source());
  operation.apply(ConfirmTimeOut{});  // no stroke is taken before
  pipeline::FrameResult frame;
  frame.tip_is_valid = frame.camera_from_world.is_valid = true;
  for (const strokes::CurvePoint& point : part(0, 0.1)) {
    frame.timestamp_ns += 16'666'667;
    frame.tip_in_world_mm = point.position_mm;
    operation.process_recorded(frame);
  }
  operation.apply(RegisterStrokes{});
  EXPECT_TRUE(operation.state()->registration->is_fitting);
  RegistrationWork work([]() -> SurfaceIndexPtr { throw std::runtime_error("the mesh is empty"); },
                        work_options(operation.setup()));
  operation.take_outcome(work.outcome());
  EXPECT_FALSE(operation.state()->registration->is_fitting);
}

// The screen asks in every frame: as long as nothing changes it gets the same object.
TEST_F(RegistrationRules, TheRegistrationsStateIsMadeAnewOnlyAfterAChange) {
  run_.show(run_.frame());
  const auto first = run_.state()->registration;
  run_.show(run_.frame());
  EXPECT_EQ(run_.state()->registration, first);
  run_.touch({1, 2, 3}, TouchControlPoint{});
  EXPECT_NE(run_.state()->registration, first);
}

// What was asked for before the plan changed comes after it, with its error at the tunnel of before. Which is
// the better one is asked at the tunnel of now.
TEST(RegistrationLedger, WhatWasFoundForAnotherTunnelIsComparedAtThisOne) {
  // Good at the origin, where the tunnel of before was; by how much it turns, it is not where that of now is.
  const auto found = [](double error_at_origin_mm, double sigma_turn_rad) {
    registration::OnlineResult online;
    online.state = registration::OnlineState::Confirmed;
    registration::RegistrationSummary& summary = online.registration;
    summary.has_pose = summary.reliable = true;
    summary.reasons.clear();
    summary.covariance.diagonal().head<3>().setConstant(error_at_origin_mm * error_at_origin_mm / 3);
    summary.covariance.diagonal().tail<3>().setConstant(sigma_turn_rad * sigma_turn_rad);
    summary.predicted_tre_mm = registration::predicted_error_mm(summary, Eigen::Vector3d::Zero());
    return std::make_shared<const registration::OnlineResult>(online);
  };
  const auto even = found(0.5, 0), turns = found(0.1, 0.005), turns_much = found(0.1, 0.02);
  const Eigen::Vector3d target_mm(100, 0, 0);
  ASSERT_LT(turns->registration.predicted_tre_mm, 0.2);
  ASSERT_GT(registration::predicted_error_mm(turns->registration, target_mm), 0.6);
  ASSERT_GT(registration::predicted_error_mm(turns_much->registration, target_mm),
            registration::kMaxError_mm);
  RegistrationLedger ledger(nullptr, std::nullopt, {});
  ledger.aim_at(target_mm);
  ledger.take_online(turns_much, 1);
  EXPECT_EQ(ledger.in_force().standing, Standing::None) << "there it is not reliable";
  ledger.take_online(even, 2);
  ASSERT_EQ(ledger.in_force().standing, Standing::Stands);
  ledger.take_online(turns, 3);
  EXPECT_EQ(ledger.entries()->size(), 1U) << "it is better elsewhere";
  ledger.take_fit(std::make_shared<const registration::RegistrationSummary>(turns->registration), 4, 300);
  ASSERT_EQ(ledger.entries()->size(), 2U);
  ledger.take_online(even, 5);
  EXPECT_EQ(ledger.entries()->size(), 3U) << "it is clearly better here";
}

// Cartilage of 2 mm on a bone that was segmented bare: what was assumed is said, and touches on it lie where
// they should.
TEST_F(RegistrationRules, TouchesOnCartilageLieWhereTheyShould) {
  const auto covered = registration::cartilage_trial(phantom_bone(), trial_, 2);
  OperationSetup setup = test::phantom_setup();
  setup.cartilage = covered.region;
  PhantomOperation run(setup);
  run.start(test::scripted_source());
  run.draw({covered.trial.curves.begin(), covered.trial.curves.begin() + 600});
  ASSERT_EQ(run.in_force().standing, Standing::Stands);
  ASSERT_EQ(run.in_force().registration->assumptions.size(), 1U);
  EXPECT_NEAR(registration::thickness_in(run.in_force().registration->assumptions[0]), 2, 0.3);
  for (const double up_mm : {12.0, 16.0}) {
    const geometry::SurfacePoint place =
        phantom_bone().surface->closest_point(phantom_bone().target_mm + Eigen::Vector3d(0, 0, up_mm));
    run.touch(trial_.marker_from_bone * (place.point_mm + 2 * place.normal));
    EXPECT_NEAR(run.state()->registration->touches.last().distance_mm.value(), 0, 0.4);
  }
  EXPECT_FALSE(run.state()->registration->alarm);
}

}  // namespace
}  // namespace arthronaut::operation
