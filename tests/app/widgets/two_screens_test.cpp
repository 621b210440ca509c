#include "app/widgets/two_screens.h"

#include <gtest/gtest.h>

namespace arthronaut::widgets {
namespace {

const ScreenArea kFirst{0, 0, 1920, 1080};

void expect_area(const std::optional<ScreenArea>& is, const ScreenArea& wanted) {
  ASSERT_TRUE(is);
  EXPECT_EQ(is->x, wanted.x);
  EXPECT_EQ(is->y, wanted.y);
  EXPECT_EQ(is->width, wanted.width);
  EXPECT_EQ(is->height, wanted.height);
}

TEST(TwoScreens, TheSeamIsTheMiddleOnWhicheverSideTheSecondStands) {
  expect_area(across_two({kFirst, {1920, 0, 1920, 1080}}), {0, 0, 3840, 1080});
  expect_area(across_two({kFirst, {-1920, 0, 1920, 1080}}), {-1920, 0, 3840, 1080});
  // Of another size and hung lower: what both have, as much of the one as of the other.
  expect_area(across_two({kFirst, {1920, 100, 1280, 1024}}), {640, 100, 2560, 980});
}

TEST(TwoScreens, OneScreenOrScreensThatDoNotStandSideBySideAreNotTwo) {
  EXPECT_FALSE(across_two({}));
  EXPECT_FALSE(across_two({kFirst}));
  EXPECT_FALSE(across_two({kFirst, kFirst})) << "mirrored";
  EXPECT_FALSE(across_two({kFirst, {0, 1080, 1920, 1080}})) << "one above the other";
  EXPECT_FALSE(across_two({kFirst, {1920, 900, 1920, 1080}})) << "hardly a common line";
}

// The screens that are sold: which of them are one and which are two beside each other.
TEST(TwoScreens, AWideScreenIsOneAndTwoNarrowOnesAreTwo) {
  for (const auto& [width, height] : {std::pair{1920.F, 1080.F}, {2560.F, 1080.F}, {3440.F, 1440.F}})
    EXPECT_FALSE(is_two_screens(width, height)) << width;
  for (const auto& [width, height] : {std::pair{3840.F, 1080.F}, {3840.F, 1200.F}, {3200.F, 1200.F}})
    EXPECT_TRUE(is_two_screens(width, height)) << width;
}

}  // namespace
}  // namespace arthronaut::widgets
