#include "navigation/pipeline/torn_picture.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace arthronaut::pipeline {
namespace {

constexpr std::size_t kColumns = TornPicture::kColumns, kRows = TornPicture::kRows;
using Step = std::array<float, kColumns * kRows>;

constexpr int kHeight = 1080;
const PictureSeam::Signs kNoSeam;

std::int64_t time_ns(int frame) { return frame * 1'000'000'000LL / 60; }

// Changes from frame to frame of a source with noise, whose scene moves here and there.
class Changes {
 public:
  Step next(bool moves = true) {
    std::uniform_real_distribution<float> noise(1.6F, 1.9F), motion(0, 12);
    Step step;
    for (float& change : step) change = noise(random_) + (moves ? motion(random_) : 0);
    return step;
  }

 private:
  std::mt19937 random_{5};
};

void repeat_rows(Step& step, std::size_t from, std::size_t to) {
  std::fill(step.begin() + static_cast<std::ptrdiff_t>(from * kColumns),
            step.begin() + static_cast<std::ptrdiff_t>(to * kColumns), 0.05F);
}

// Torn at any height from either side, each time but never else.
TEST(TornPicture, IsSeenInThatFrame) {
  TornPicture torn;
  Changes changes;
  for (int i = 0; i < 400; ++i) {
    Step step = changes.next(i % 50 < 25);
    const bool is_torn = i > 60 && i % 10 == 0;
    const std::size_t row = 2 + static_cast<std::size_t>(i / 10) % 5;
    if (is_torn) i % 20 == 0 ? repeat_rows(step, row, kRows) : repeat_rows(step, 0, row);
    EXPECT_EQ(torn.observe(step, kNoSeam, kHeight, time_ns(i)), is_torn) << i;
  }
}

// Neither a picture that is repeated as a whole, nor a scope that stops, nor one tool that moves in a still
// scene with noise.
TEST(TornPicture, IsNoneOtherwise) {
  TornPicture repeated, stopping, tool;
  Changes changes;
  for (int i = 0; i < 300; ++i) {
    Step whole = changes.next();
    if (i % 2 == 1) repeat_rows(whole, 0, kRows);
    EXPECT_FALSE(repeated.observe(whole, kNoSeam, kHeight, time_ns(i))) << i;
    EXPECT_FALSE(stopping.observe(changes.next(i % 100 < 50), kNoSeam, kHeight, time_ns(i))) << i;
    Step above = changes.next(false);
    for (std::size_t tile = 0; tile < 3 * kColumns; ++tile) above[tile] += 9;
    EXPECT_FALSE(tool.observe(above, kNoSeam, kHeight, time_ns(i))) << i;
  }
}

// A codec that leaves the lower half as it is while nothing moves there, which fits the upper half: told for
// a few pictures, then learnt.
TEST(TornPicture, IsNotToldForLongOfACodecThatSkips) {
  TornPicture torn;
  Changes changes;
  for (int i = 0; i < 60; ++i) (void)torn.observe(changes.next(), kNoSeam, kHeight, time_ns(i));
  int told = 0;
  for (int i = 60; i < 360; ++i) {
    Step step = changes.next();
    repeat_rows(step, 4, kRows);
    told += torn.observe(step, kNoSeam, kHeight, time_ns(i)) ? 1 : 0;
  }
  EXPECT_LE(told, 3);
}

// The lower or the upper half was lost and stands: it does not fit the other where the motion begins, and is
// told until it is renewed, key frames that code it anew notwithstanding; then no longer.
TEST(TornPicture, IsToldAsLongAsAPartIsStale) {
  for (const bool is_lower : {true, false}) {
    TornPicture torn;
    Changes changes;
    for (int i = 0; i < 60; ++i) EXPECT_FALSE(torn.observe(changes.next(), kNoSeam, kHeight, time_ns(i)));
    for (int i = 60; i < 360; ++i) {
      Step step = changes.next();
      if (i % 60 != 59) is_lower ? repeat_rows(step, 5, kRows) : repeat_rows(step, 0, 4);
      // In one picture alone, as long as the rows still have something of each other.
      const PictureSeam::Signs seam = i == 61 ? PictureSeam::Signs{4, 560, is_lower, false} : kNoSeam;
      EXPECT_TRUE(torn.observe(step, seam, kHeight, time_ns(i))) << i;
    }
    int told = 0;
    for (int i = 360; i < 400; ++i)
      told += torn.observe(changes.next(), kNoSeam, kHeight, time_ns(i)) ? 1 : 0;
    EXPECT_LE(told, 2);
  }
}

// A seam that is clear by itself is told whatever the tiles do, and nothing stays of it; one that stands in
// every picture is told in every picture. Few votes alone tell nothing.
TEST(TornPicture, IsToldOfASeamAlone) {
  TornPicture torn;
  Changes changes;
  for (int i = 0; i < 200; ++i) {
    const PictureSeam::Signs seam{i % 10 == 5 ? 8 : 3, 300, i % 20 < 10, i > 150};
    EXPECT_EQ(torn.observe(changes.next(), seam, kHeight, time_ns(i)), i % 10 == 5 || i > 150) << i;
  }
}

// A source without noise, such as a renderer, is not judged by its tiles.
TEST(TornPicture, NeedsNoise) {
  TornPicture torn;
  for (int i = 0; i < 100; ++i) {
    Step step{};
    if (i % 7 == 0) std::fill(step.begin(), step.begin() + 4 * kColumns, 8.0F);
    EXPECT_FALSE(torn.observe(step, kNoSeam, kHeight, time_ns(i))) << i;
  }
}

}  // namespace
}  // namespace arthronaut::pipeline
