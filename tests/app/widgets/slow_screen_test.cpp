#include "app/widgets/slow_screen.h"

#include <gtest/gtest.h>

namespace arthronaut::widgets {
namespace {

void draw(SlowScreen& screen, int frames, double frame_s, bool matters = true) {
  for (int i = 0; i < frames; ++i) screen.drawn(frame_s, matters);
}

TEST(SlowScreen, Hazard34IsToldWhileAnOperationRuns) {
  SlowScreen screen;
  draw(screen, 100, 0.02);
  EXPECT_EQ(screen.words(), "");
  draw(screen, 21, 0.07);
  EXPECT_EQ(screen.words(), "The screen is slow: 14 pictures a second. End other programs");
  draw(screen, 21, 0.02);
  EXPECT_EQ(screen.words(), "") << "it is over";
}

// Single frames that take long are no slow screen, and at the limit the words do not flicker.
TEST(SlowScreen, NeedsMoreThanHalfOfTheFramesAndStaysUntilItIsOver) {
  SlowScreen screen;
  for (int i = 0; i < 200; ++i) screen.drawn(i % 3 == 0 ? 0.2 : 0.03, true);
  EXPECT_EQ(screen.words(), "");
  draw(screen, 40, 0.051);
  EXPECT_NE(screen.words(), "");
  draw(screen, 40, 0.045);
  EXPECT_NE(screen.words(), "");
  draw(screen, 40, 0.042);
  EXPECT_EQ(screen.words(), "");
}

TEST(SlowScreen, WithoutAnOperationNothingIsSaid) {
  SlowScreen screen;
  draw(screen, 100, 0.2, false);
  EXPECT_EQ(screen.words(), "");
  draw(screen, 39, 0.2);
  EXPECT_EQ(screen.words(), "") << "too few to tell";
  draw(screen, 1, 0.2);
  EXPECT_NE(screen.words(), "");
  draw(screen, 1, 0.2, false);
  EXPECT_EQ(screen.words(), "");
}

}  // namespace
}  // namespace arthronaut::widgets
