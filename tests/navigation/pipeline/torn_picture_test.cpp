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

// What H.264 (8 Mb/s) makes of pictures that were torn before they were coded, as measured: the largest
// change of each row of tiles. It refines what was not renewed.
Step coded(const std::array<float, kRows>& largest, std::mt19937& random) {
  std::uniform_real_distribution<float> share(0.05F, 0.6F);
  Step step;
  for (std::size_t i = 0; i < step.size(); ++i)
    step[i] = largest[i / kColumns] * (i % kColumns == 5 ? 1 : share(random));
  return step;
}

TEST(TornPicture, IsSeenInAnEncodedStreamByTheStopOfAPart) {
  const std::vector<std::array<float, kRows>> live{{3.2F, 5.7F, 13.3F, 4.5F, 4.3F, 13.8F, 4.6F, 1.4F},
                                                   {3.6F, 6.1F, 13.3F, 4.8F, 5.4F, 14.9F, 5.1F, 2.7F},
                                                   {2.2F, 6.1F, 13.3F, 4.8F, 4.8F, 15.0F, 5.0F, 2.8F}};
  const std::vector<std::array<float, kRows>> torn{{3.4F, 5.4F, 13.3F, 4.5F, 0.12F, 0.24F, 0.29F, 0.55F},
                                                   {2.9F, 5.0F, 10.8F, 4.8F, 0.04F, 0.10F, 0.53F, 0.75F},
                                                   // What hardly moves at the lower end it refines as much.
                                                   {2.7F, 4.8F, 9.6F, 4.1F, 0.17F, 0.57F, 0.38F, 1.1F}};
  // A picture that hangs, a key frame of it, a tool that stops in one part, and a part that had not moved.
  const std::vector<std::array<float, kRows>> others{{0.2F, 0.3F, 0.8F, 0.6F, 0.1F, 0.2F, 0.3F, 0.1F},
                                                     {2.4F, 2.4F, 2.5F, 2.4F, 2.1F, 2.4F, 2.2F, 2.3F},
                                                     {3.2F, 5.7F, 13.3F, 4.5F, 4.3F, 1.2F, 4.6F, 1.4F}};
  std::mt19937 random(11);
  TornPicture watch;
  int frame = 0;
  const auto observe = [&](const std::array<float, kRows>& largest) {
    return watch.observe(coded(largest, random), kNoSeam, kHeight, time_ns(frame++));
  };
  for (int round = 0; round < 8; ++round) {
    for (const auto& rows : live) EXPECT_FALSE(observe(rows)) << frame;
    EXPECT_TRUE(observe(torn[static_cast<std::size_t>(round) % torn.size()])) << frame;
    for (const auto& rows : live) EXPECT_FALSE(observe(rows)) << frame;
    EXPECT_FALSE(observe(others[static_cast<std::size_t>(round) % others.size()])) << frame;
  }
}

// A tool that is elsewhere in the next picture and rests there, as a cut makes it, while the scope goes on.
// Neither is where it moves on from there; a part that is torn in every other picture is.
TEST(TornPicture, AJumpOfOnePictureIsNone) {
  const std::array<float, kRows> rests{4.2F, 5.1F, 4.6F, 4.0F, 0.9F, 0.8F, 1.0F, 0.9F},
      jumps{4.4F, 5.0F, 4.5F, 4.1F, 60, 75, 70, 50}, moves{4.2F, 5.1F, 4.6F, 4.0F, 8, 9, 7, 8},
      stands{4.3F, 5.2F, 4.4F, 4.2F, 0.2F, 0.3F, 0.2F, 0.3F};
  std::mt19937 random(11);
  TornPicture watch;
  int frame = 0;
  const auto observe = [&](const std::array<float, kRows>& largest) {
    return watch.observe(coded(largest, random), kNoSeam, kHeight, time_ns(frame++));
  };
  for (int round = 0; round < 4; ++round) {
    for (int i = 0; i < 10; ++i) EXPECT_FALSE(observe(rests)) << frame;
    EXPECT_FALSE(observe(jumps)) << frame;
  }
  EXPECT_FALSE(observe(rests));
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(observe(moves));
  for (int i = 0; i < 8; ++i) EXPECT_EQ(observe(i % 2 == 0 ? stands : moves), i % 2 == 0) << i;
}

// A tool is led through one half of the picture and rests at once, the scope with it: what is left is noise,
// as large as in the other half, as measured of the simulated sensor. A part that was not renewed has none.
TEST(TornPicture, AToolThatComesToRestIsNone) {
  const std::array<float, kRows> led{11.6F, 37.2F, 48.6F, 42.5F, 2.7F, 1.8F, 1.75F, 1.6F},
      rests{1.5F, 1.9F, 1.9F, 1.9F, 1.85F, 1.85F, 1.8F, 1.6F};
  TornPicture watch;
  int frame = 0;
  for (int round = 0; round < 4; ++round) {
    for (const auto* const rows : {&rests, &rests, &led, &led, &led, &rests}) {
      Step step;
      for (std::size_t i = 0; i < step.size(); ++i) step[i] = (*rows)[i / kColumns] - 0.3F * (i % 2 == 0);
      EXPECT_FALSE(watch.observe(step, kNoSeam, kHeight, time_ns(frame++))) << frame;
    }
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
