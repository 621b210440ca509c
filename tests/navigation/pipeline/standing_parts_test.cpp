#include "navigation/pipeline/standing_parts.h"

#include <gtest/gtest.h>

#include <random>

namespace arthronaut::pipeline {
namespace {

constexpr int kWidth = 640, kRows = 64;
constexpr double kMostRepeat = 0.3;

// Each part by itself: from the third picture on end in which it was not renewed, until it was for three. A
// key frame now and then changes nothing, nor does a single repeat.
TEST(StandingParts, TellsWhichPartIsNotRenewed) {
  StandingParts parts;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(100, 1.5);
  std::vector<std::uint8_t> now(static_cast<std::size_t>(kWidth) * kRows), before = now;
  for (int i = 0; i < 200; ++i) {
    before = now;
    const bool is_lost = i >= 50 && i < 150, is_key_frame = i % 30 == 10;
    for (std::size_t at = 0; at < now.size(); ++at) {
      const bool is_lower = at >= now.size() / 2, is_left = at % kWidth < kWidth / 2;
      if (is_lower && is_lost && !is_key_frame) continue;
      if (!is_lower && is_left && i % 3 == 0) continue;  // a repeat now and then
      now[at] = static_cast<std::uint8_t>(noise(random));
    }
    parts.observe(now, before, kWidth, kMostRepeat);
    EXPECT_FALSE(parts.stand(4, 12, 30, 200)) << i;
    EXPECT_EQ(parts.stand(40, 50, 300, 420), i >= 52 && i < 152) << i;
    EXPECT_EQ(parts.stand(28, 37, 300, 420), i >= 52 && i < 152) << i << ": more than half of it";
    EXPECT_FALSE(parts.stand(20, 33, 300, 420)) << i << ": a twelfth";
  }
}

// Nothing lies there.
TEST(StandingParts, NothingStandsWhereNothingIs) {
  StandingParts parts;
  EXPECT_FALSE(parts.stand(0, 64, 0, 640));
  const std::vector<std::uint8_t> picture(static_cast<std::size_t>(kWidth) * kRows, 9);
  for (int i = 0; i < 5; ++i) parts.observe(picture, picture, kWidth, kMostRepeat);
  EXPECT_TRUE(parts.stand(0, 64, 0, 640));
  EXPECT_FALSE(parts.stand(10, 10, 0, 640));
  EXPECT_FALSE(parts.stand(70, 80, 0, 640));
}

}  // namespace
}  // namespace arthronaut::pipeline
