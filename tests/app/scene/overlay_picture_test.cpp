#include "app/scene/overlay_picture.h"

#include <gtest/gtest.h>

namespace arthronaut::scene {
namespace {

constexpr int kSize_px = 100;

Image drawn(const OverlayLine& line, const FrameCut& cut = {}) {
  Image picture{kSize_px, kSize_px, std::vector<std::uint8_t>(3UL * kSize_px * kSize_px, 0)};
  draw_overlay(picture, {line}, cut);
  return picture;
}

bool is_drawn(const Image& picture, int x, int y) {
  return picture.rgb[3 * (static_cast<std::size_t>(y) * kSize_px + static_cast<std::size_t>(x)) + 1] > 0;
}

TEST(OverlayPicture, HiddenLinesAreDottedAndFacesLeftOut) {
  OverlayLine line{OverlayLine::Kind::TunnelWall, false, {{10, 50}, {90, 50}}, 1};
  int gaps = 0, hidden_gaps = 0, hidden_dots = 0;
  const Image seen = drawn(line);
  line.is_hidden = true;
  const Image hidden = drawn(line);
  for (int x = 10; x <= 90; ++x) {
    gaps += is_drawn(seen, x, 50) ? 0 : 1;
    (is_drawn(hidden, x, 50) ? hidden_dots : hidden_gaps) += 1;
  }
  EXPECT_EQ(gaps, 0);
  EXPECT_GT(hidden_dots, 20);
  EXPECT_GT(hidden_gaps, 20);
  line = {OverlayLine::Kind::TunnelFace, false, {{10, 10}, {90, 10}, {90, 90}, {10, 90}}, 1};
  EXPECT_EQ(drawn(line).rgb, std::vector<std::uint8_t>(3UL * kSize_px * kSize_px, 0));
}

// Of a frame's part, at another size; what lies beyond it is not drawn anywhere.
TEST(OverlayPicture, FollowsTheCut) {
  const OverlayLine line{OverlayLine::Kind::EntryRing, false, {{300, 240}, {900, 240}}, 1};
  const Image picture = drawn(line, {.corner_px = {200, 100}, .scale = 4});
  EXPECT_FALSE(is_drawn(picture, 20, 35));
  for (int x = 25; x < kSize_px; ++x) EXPECT_TRUE(is_drawn(picture, x, 35)) << x;
  EXPECT_FALSE(is_drawn(picture, 50, 38));
}

// Read in the picture itself: what is written beside it is lost on the way to an archive.
TEST(OverlayPicture, ASimulatorsPictureSaysSoInItsPixels) {
  constexpr int kWidth_px = 960, kHeight_px = 540;
  Image picture{kWidth_px, kHeight_px, std::vector<std::uint8_t>(3UL * kWidth_px * kHeight_px, 90)};
  mark_simulated(picture);
  std::size_t bright = 0, below = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    const bool is_bar = i / 3 / kWidth_px < kHeight_px / 16;
    bright += is_bar && picture.rgb[i] > 200;
    below += !is_bar && picture.rgb[i] != 90;
  }
  EXPECT_GT(bright, 500U) << "letters";
  EXPECT_EQ(below, 0U) << "the picture itself is left as it is";
}

}  // namespace
}  // namespace arthronaut::scene
