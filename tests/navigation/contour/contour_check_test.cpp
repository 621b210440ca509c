#include "navigation/contour/contour_check.h"

#include <gtest/gtest.h>

#include "tests/counted_allocations.h"
#include "tests/navigation/contour/watched_ball.h"

namespace arthronaut::contour {
namespace {

TEST(ContourCheck, HoldsWhileTheBoneLiesWhereItLay) {
  WatchedBall watched;
  EXPECT_EQ(watched.look().reason, NotCheckedReason::Settling);
  watched.watch(3);
  EXPECT_EQ(watched.check().verdict().state, ContourState::Holds);
  for (int i = 0; i < 90; ++i) EXPECT_EQ(watched.look().state, ContourState::Holds) << i;
}

// Where it lies is learned from pictures, and not from the time between two of them.
TEST(ContourCheck, AGapInThePicturesTeachesNothing) {
  WatchedBall watched;
  const geometry::RigidTransform camera_from_world = before_the_lens();
  const camera::GrayView luma = watched.picture().draw(camera_from_world);
  const auto look_at = [&](double time_s) {
    return watched.check().look(luma, watched.picture().camera(), camera_from_world, {},
                                static_cast<std::int64_t>(1e9 * time_s));
  };
  for (const double time_s : {1.0, 3.0, 5.0}) {
    const ContourVerdict seen = look_at(time_s);
    EXPECT_EQ(seen.state, ContourState::NotChecked) << time_s;
    EXPECT_EQ(seen.reason, NotCheckedReason::Settling) << time_s;
  }
  for (int i = 1; i <= 60; ++i) (void)look_at(5 + i / 15.0);
  EXPECT_EQ(watched.check().verdict().state, ContourState::Holds);
}

// A registration that was never exact is no drift either.
TEST(ContourCheck, HoldsForARegistrationThatIsOffFromTheBeginning) {
  WatchedBall watched(geometry::exp((geometry::Vector6d() << 0.4, -0.3, 0.2, 0.01, -0.01, 0.01).finished()));
  watched.watch(8);
  EXPECT_EQ(watched.check().verdict().state, ContourState::Holds);
}

TEST(ContourCheck, TellsAMillimetreWithinTwoSeconds) {
  for (const Eigen::Vector3d& drift :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(-0.6, 0.6, 0.5)}) {
    WatchedBall watched;
    watched.watch(4);
    const auto after_s = watched.told_after_s(moved_by(drift.normalized()));
    ASSERT_TRUE(after_s) << drift.transpose();
    EXPECT_LT(*after_s, 2) << drift.transpose();
    EXPECT_NEAR(watched.check().verdict().drift_mm, 1, 0.5);
    watched.watch(1);
    EXPECT_EQ(watched.check().verdict().state, ContourState::Drifted) << "back again is no excuse";
    watched.check().begin({});
    EXPECT_NE(watched.check().verdict().state, ContourState::Drifted);
  }
}

// Nothing is known of a bone that cannot be seen: what it does behind a glove may have been done at once.
TEST(ContourCheck, WhatIsCoveredIsNotSeenToHold) {
  WatchedBall watched;
  watched.watch(4);
  const std::int64_t covered_ns = watched.check().verdict().timestamp_ns;
  const Covered all{{320, 180}, {320, 180}, 1000};
  for (int i = 0; i < 90; ++i) (void)watched.look(moved_by({1, 0, 0}), {&all, 1});
  EXPECT_LE(watched.check().verdict().held_until_ns, covered_ns);
  ASSERT_TRUE(watched.told_after_s(moved_by({1, 0, 0})));
  EXPECT_LE(watched.check().verdict().held_until_ns, covered_ns);
  EXPECT_GE(watched.check().verdict().held_until_ns, covered_ns - 2'500'000'000);
}

TEST(ContourCheck, SaysWhyNothingIsChecked) {
  WatchedBall watched;
  watched.watch(3);
  const auto& blind = watched.check().look({}, watched.picture().camera(), std::nullopt, {}, 4'000'000'000);
  EXPECT_EQ(blind.state, ContourState::NotChecked);
  EXPECT_EQ(blind.reason, NotCheckedReason::NoPose);
  // A glove over all of the view.
  const Covered all{{320, 180}, {320, 180}, 1000};
  for (int i = 0; i < 60; ++i) (void)watched.look(moved_by({1, 0, 0}), {&all, 1});
  EXPECT_EQ(watched.check().verdict().state, ContourState::NotChecked);
  EXPECT_EQ(watched.check().verdict().reason, NotCheckedReason::TooLittleInView);
  watched.check().end();
  (void)watched.look();
  EXPECT_EQ(watched.check().verdict().reason, NotCheckedReason::NoRegistration);
}

// Not the first one either, nor the first with a registration.
TEST(ContourCheck, NoPictureAllocatesWhereItsSizeWasTold) {
  ContourCheck check(ball_mesh());
  RenderedBone picture(ball_mesh());
  const geometry::RigidTransform view = before_the_lens();
  const camera::GrayView luma = picture.draw(view);
  check.reserve_for({luma.width, luma.height});
  test::start_counting_allocations();
  check.begin({});
  for (int i = 1; i < 60; ++i) (void)check.look(luma, picture.camera(), view, {}, i * kBallFrame_ns);
  EXPECT_EQ(test::stop_counting_allocations(), 0);
  EXPECT_EQ(check.verdict().state, ContourState::Holds);
}

// The same pictures give the same verdicts to the last bit, and no picture allocates.
TEST(ContourCheck, IsDeterministicAndAllocatesNothing) {
  WatchedBall one, two;
  for (int i = 0; i < 40; ++i) {
    const ContourVerdict a = one.look(), b = two.look();
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.share_seen, b.share_seen);
    EXPECT_EQ(one.check().surface_test().verdict().lead, two.check().surface_test().verdict().lead);
  }
  const geometry::RigidTransform view = before_the_lens();
  const camera::GrayView luma = one.picture().draw(view);
  (void)one.check().look(luma, one.picture().camera(), view, {}, 9'000'000'000);
  test::start_counting_allocations();
  for (int i = 1; i < 40; ++i)
    (void)one.check().look(luma, one.picture().camera(), view, {}, 9'000'000'000 + i * kBallFrame_ns);
  EXPECT_EQ(test::stop_counting_allocations(), 0);
}

}  // namespace
}  // namespace arthronaut::contour
