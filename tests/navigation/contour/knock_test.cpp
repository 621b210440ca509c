// A bone that was knocked by more than the drift test compares, in drawn pictures.
#include <gtest/gtest.h>

#include <vector>

#include "tests/counted_allocations.h"
#include "tests/navigation/contour/watched_ball.h"

namespace arthronaut::contour {
namespace {

const Eigen::Vector3d kWays[] = {{1, 0, 0}, {0, 1, 0}, {-0.7, 0.6, 0.3}};

bool is_told(ContourState state) {
  return state == ContourState::Drifted || state == ContourState::LooksOtherwise;
}

// Told as moved where it was found again, else as what it is: not what it was.
TEST(KnockedBone, Hazard25AHardKnockIsToldWithinTwoSeconds) {
  int turn = 0;
  for (const double size_mm : {2.0, 3.0, 5.0, 8.0}) {
    const Eigen::Vector3d way = kWays[turn++ % 3];
    WatchedBall watched;
    watched.watch(3);
    ASSERT_EQ(watched.check().verdict().state, ContourState::Holds);
    watched.watch(2, moved_by(size_mm * way.normalized()));
    EXPECT_TRUE(is_told(watched.check().verdict().state)) << size_mm << " mm, " << way.transpose();
  }
}

TEST(KnockedBone, IsFoundAgainWhereItLies) {
  for (const Eigen::Vector3d& way : kWays) {
    WatchedBall watched;
    watched.watch(4);
    const auto told_s = watched.told_after_s(moved_by(4 * way.normalized()));
    ASSERT_TRUE(told_s) << way.transpose();
    // The steps of the search across the line of sight, and 3 mm along it.
    EXPECT_NEAR(watched.check().verdict().drift_mm, 4, 1.5) << way.transpose();
  }
}

TEST(KnockedBone, AKnockThatTakesAThirdOfASecondIsToldToo) {
  WatchedBall watched;
  watched.watch(4);
  for (int i = 1; i <= 5; ++i) (void)watched.look(moved_by({0.8 * i, 0, 0}));
  watched.watch(1.7, moved_by({4, 0, 0}));
  EXPECT_TRUE(is_told(watched.check().verdict().state));
}

// Somebody's glove, smoke, blood: nothing is seen of the bone, and nothing of another one either.
TEST(KnockedBone, APlainCoverIsNoKnock) {
  WatchedBall watched;
  watched.watch(4);
  const std::vector<std::uint8_t> grey(640 * 360, 90);
  for (int i = 1; i < 60; ++i) {
    const auto& verdict = watched.check().look({grey.data(), 640, 360, 640}, watched.picture().camera(),
                                               before_the_lens(), {}, (60 + i) * kBallFrame_ns);
    EXPECT_FALSE(is_told(verdict.state)) << i;
    if (i > 15) {
      EXPECT_EQ(verdict.state, ContourState::NotChecked) << i;
    }
  }
}

// A search runs over many pictures, and none of them allocates.
TEST(KnockedBone, LookingForItAllocatesNothing) {
  ContourCheck check(ball_mesh());
  RenderedBone picture(ball_mesh());
  const geometry::RigidTransform view = before_the_lens();
  const camera::GrayView luma = picture.draw(view);
  check.reserve_for({luma.width, luma.height});
  check.begin({});
  int frame = 0;
  for (; frame < 60; ++frame) (void)check.look(luma, picture.camera(), view, {}, (1 + frame) * kBallFrame_ns);
  const geometry::RigidTransform elsewhere = view * moved_by({5, 0, 0});
  test::start_counting_allocations();
  for (; frame < 90; ++frame)
    (void)check.look(luma, picture.camera(), elsewhere, {}, (1 + frame) * kBallFrame_ns);
  EXPECT_EQ(test::stop_counting_allocations(), 0);
  EXPECT_GE(check.knock().search_count(), 1);
  EXPECT_EQ(check.verdict().state, ContourState::Drifted);
}

}  // namespace
}  // namespace arthronaut::contour
