#include "navigation/pipeline/picture_seam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace arthronaut::pipeline {
namespace {

constexpr int kWidth = 640, kHeight = 240;
constexpr int kMany = 6;  // votes that TornPicture believes at once
using Picture = std::vector<std::uint8_t>;

// Tissue with texture of two directions, moved by so many pixels, with a sensor's noise.
Picture scene(double moved_px, unsigned seed, double noise = 2) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, noise);
  Picture picture(static_cast<std::size_t>(kWidth) * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double u = x + moved_px, v = y - moved_px / 8;
      const double value = 110 + 40 * std::sin(u / 40) * std::cos(v / 31) +
                           25 * std::sin(u / 7.1 + (x / 40 % 2 == 0 ? -v : v) / 5.3);
      picture[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)] =
          static_cast<std::uint8_t>(std::clamp(std::lround(value + normal(random)), 0L, 255L));
    }
  }
  return picture;
}

camera::GrayView view(const Picture& picture) { return {picture.data(), kWidth, kHeight, kWidth}; }

// The rows of `above` down to `row`, then those of `below`.
Picture joined(const Picture& above, const Picture& below, int row) {
  Picture picture = above;
  const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(row + 1) * kWidth;
  std::copy(below.begin() + from, below.end(), picture.begin() + from);
  return picture;
}

// At any height, either part the older one: the row is found, and the older part is named.
TEST(PictureSeam, IsFoundInThePictureThatHasIt) {
  for (const int row : {20, 133, 179, 215}) {
    for (const bool lower_is_older : {true, false}) {
      PictureSeam seam;
      const Picture before = scene(0, 1), now = scene(8, 2);
      (void)seam.observe(view(before));
      const auto signs =
          seam.observe(view(lower_is_older ? joined(now, before, row) : joined(before, now, row)));
      EXPECT_GE(signs.votes, kMany) << row;
      EXPECT_EQ(signs.row, row);
      EXPECT_EQ(signs.lower_is_older, lower_is_older);
    }
  }
}

// Every picture is torn, by one that is one or two pictures older, while the scope moves to and fro: seen at
// once, and while it stands still at the turns of the motion too.
TEST(PictureSeam, StandsInEveryPicture) {
  for (const int late : {1, 2}) {
    PictureSeam seam;
    int torn = 0;
    std::vector<Picture> pictures;
    for (int i = 0; i < 60; ++i) {
      pictures.push_back(scene(50 * std::sin(i / 10.0), static_cast<unsigned>(i)));
      if (i < late) continue;
      const Picture& older = pictures[static_cast<std::size_t>(i - late)];
      const auto signs = seam.observe(view(joined(pictures.back(), older, 130)));
      if (i > 10) torn += signs.is_lasting || signs.votes >= kMany ? 1 : 0;
    }
    EXPECT_EQ(torn, 49) << late;
  }
}

// Whatever the picture is but torn: moved, still, brighter, repeated, a bar of text that comes and goes; with
// little noise and much.
TEST(PictureSeam, IsNoneInAPictureOfOneMoment) {
  for (const double noise : {0.0, 2.0, 5.0}) {
    PictureSeam seam;
    Picture picture;
    for (int i = 0; i < 50; ++i) {
      if (i % 4 != 3) picture = scene(i < 30 ? 3.0 * i : 90, static_cast<unsigned>(i), noise);
      Picture shown = picture;
      for (auto& value : shown)
        value = static_cast<std::uint8_t>(std::min(255, value + (i % 20 < 10 ? 0 : 12)));
      const auto signs = seam.observe(view(shown));
      EXPECT_LT(signs.votes, kMany) << i << " with noise " << noise;
      EXPECT_FALSE(signs.is_lasting) << i << " with noise " << noise;
    }
  }
}

// A picture of another size begins anew; one too small to be judged is none.
TEST(PictureSeam, BeginsAnewWithAnotherSize) {
  PictureSeam seam;
  const Picture picture = scene(0, 1), moved = scene(9, 2);
  (void)seam.observe(view(picture));
  EXPECT_EQ(seam.observe({moved.data(), kWidth, kHeight / 2, kWidth}).votes, 0);
  EXPECT_EQ(seam.observe({moved.data(), kWidth / 2, kHeight, kWidth}).votes, 0);
}

}  // namespace
}  // namespace arthronaut::pipeline
