#include "app/navigate/shown_scene.h"

#include <gtest/gtest.h>

namespace arthronaut::navigate {
namespace {

ShownScene guided_at(std::int64_t frame) {
  static const auto bone = std::make_shared<const geometry::TriangleMesh>();
  static const auto registration = std::make_shared<const operation::RegistrationState>();
  ShownScene shown;
  shown.drawn_bone = bone;
  shown.registration = registration;
  shown.guide_frame = frame;
  return shown;
}

// 60 pictures a second with a guide in each: the processor draws the bone a dozen times, a graphics card with
// each.
TEST(SceneRenewal, Hazard34AGuideThatMovesIsNotDrawnWithEveryPicture) {
  SceneRenewal by_processor, by_card;
  int drawn = 0, drawn_by_card = 0;
  for (int picture = 0; picture < 60; ++picture) {
    drawn += by_processor.is_due(guided_at(picture), 10 + picture / 60.0, true);
    drawn_by_card += by_card.is_due(guided_at(picture), 10 + picture / 60.0, false);
  }
  EXPECT_LE(drawn, 12);
  EXPECT_GE(drawn, 10);
  EXPECT_EQ(drawn_by_card, 60);
}

// What is no longer known is gone in that very frame, whenever the last one was drawn.
TEST(SceneRenewal, Hazard34AGuideThatIsLostIsGoneInThatFrame) {
  SceneRenewal renewal;
  ASSERT_TRUE(renewal.is_due(guided_at(1), 10, true));
  ASSERT_FALSE(renewal.is_due(guided_at(2), 10.001, true));
  EXPECT_TRUE(renewal.is_due(guided_at(-1), 10.002, true));
  EXPECT_EQ(renewal.shown().guide_frame, -1);
  EXPECT_TRUE(renewal.is_due(guided_at(4), 10.003, true)) << "and there again";
}

// The probe draws: strokes grow with every picture. What was taken back is gone at once.
TEST(SceneRenewal, StrokesThatGrowWaitAndWhatIsTakenBackDoesNot) {
  SceneRenewal renewal;
  ShownScene shown = guided_at(-1);
  const auto drawn = [&](std::size_t points) {
    auto state = std::make_shared<operation::RegistrationState>(*shown.registration);
    state->point_count = points;
    state->drawn = std::make_shared<const strokes::Curves>();
    shown.registration = std::move(state);
  };
  drawn(10);
  ASSERT_TRUE(renewal.is_due(shown, 10, true));
  drawn(11);
  EXPECT_FALSE(renewal.is_due(shown, 10.016, true));
  drawn(20);
  EXPECT_TRUE(renewal.is_due(shown, 10.1, true));
  drawn(12);
  EXPECT_TRUE(renewal.is_due(shown, 10.101, true));
  auto doubted = std::make_shared<operation::RegistrationState>(*shown.registration);
  doubted->in_force.standing = operation::Standing::InDoubt;
  shown.registration = std::move(doubted);
  EXPECT_TRUE(renewal.is_due(shown, 10.102, true));
}

TEST(SceneRenewal, AnotherRegistrationPlanOrLayoutIsDrawnAtOnce) {
  SceneRenewal renewal;
  ShownScene shown = guided_at(1);
  ASSERT_TRUE(renewal.is_due(shown, 10, true));
  auto other = std::make_shared<operation::RegistrationState>(*shown.registration);
  ++other->change_count;
  shown.registration = std::move(other);
  EXPECT_TRUE(renewal.is_due(shown, 10.001, true));
  shown.plan = {0, 0, 0, 0, 0, 1, 25};
  EXPECT_TRUE(renewal.is_due(shown, 10.002, true));
  shown.layout = NavigateLayout::Register;
  EXPECT_TRUE(renewal.is_due(shown, 10.003, true));
  shown.tip_frame = 1;
  EXPECT_TRUE(renewal.is_due(shown, 10.004, true));
}

TEST(SceneRenewal, NothingNewIsDrawnByNobody) {
  SceneRenewal renewal;
  ASSERT_TRUE(renewal.is_due(guided_at(1), 10, true));
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(renewal.is_due(guided_at(1), 11 + i, true));
    EXPECT_FALSE(renewal.is_due(guided_at(1), 11 + i, false));
  }
}

}  // namespace
}  // namespace arthronaut::navigate
