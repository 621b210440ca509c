#include "navigation/pipeline/picture_seam.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace arthronaut::pipeline {

namespace {

// By so much, per pixel, a row must fit one neighbour better than the other. Two rows of one moment differ by
// their noise, 2.3 grey values for a sigma of 2; the mean over a strip of 64 of them is good to 0.3.
constexpr float kClearlyBetter = 1.0F;
constexpr float kShareBetter = 0.35F;
// Pictures at either end are cut off by frames, borders and what codecs add to fill their blocks.
constexpr int kRowsLeftOut = 8;
// Measured on path-traced arthroscopy at 1080p: clean, raw or coded by H.264 (CRF 18 to 33), MPEG-4, VP8 and
// MJPEG, under 10; with a seam in every picture, raw, 59 and more.
constexpr float kLasting = 15;
constexpr float kMostCollected = 40, kLeastCollected = -15, kKept = 0.95F;

template <int Strip>
int difference(const std::uint8_t* a, const std::uint8_t* b) {
  int sum = 0;
  for (int x = 0; x < Strip; ++x) sum += std::abs(static_cast<int>(a[x]) - static_cast<int>(b[x]));
  return sum;
}

template <int Strip>
bool is_clearly_less(int less, int more) {
  const auto by = static_cast<float>(more - less);
  return by > kClearlyBetter * Strip && by > kShareBetter * static_cast<float>(more);
}

}  // namespace

PictureSeam::Signs PictureSeam::observe(const camera::GrayView& picture) {
  const auto tile = static_cast<std::size_t>(picture.width) / kTiles;
  if (tile < 32) return {};
  return tile < 64 ? judge<32>(picture) : judge<64>(picture);
}

template <int Strip>
PictureSeam::Signs PictureSeam::judge(const camera::GrayView& picture) {
  constexpr std::size_t kRow = kTiles * Strip;
  const bool is_first = picture.width != width_ || picture.height != height_;
  const auto rows = static_cast<std::size_t>(picture.height);
  if (is_first) {
    width_ = picture.width;
    height_ = picture.height;
    before_.assign(rows * kRow, 0);
    for (auto& collected : collected_) collected.assign(rows, 0);
  }
  Signs signs;
  const int tile = picture.width / static_cast<int>(kTiles), inset = (tile - Strip) / 2;
  // How much the two rows from y on differ, tile by tile.
  const auto step_below = [&](int y) {
    std::array<int, kTiles> step{};
    for (std::size_t i = 0; i < kTiles; ++i) {
      const std::ptrdiff_t at = inset + static_cast<std::ptrdiff_t>(i) * tile;
      step[i] = difference<Strip>(picture.row(y) + at, picture.row(y + 1) + at);
    }
    return step;
  };
  const int end = is_first ? 0 : picture.height - kRowsLeftOut - 1;
  std::array<int, kTiles> over{}, own{}, under{};
  for (int y = kRowsLeftOut; y < end; ++y) {
    over = y == kRowsLeftOut ? step_below(y - 1) : own;
    own = y == kRowsLeftOut ? step_below(y) : under;
    under = step_below(y + 1);
    const std::uint8_t *const above = picture.row(y) + inset, *const below = picture.row(y + 1) + inset;
    const std::uint8_t* const was_above = before_.data() + static_cast<std::size_t>(y) * kRow;
    std::array<int, 2> votes{};
    for (std::size_t i = 0; i < kTiles; ++i) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * tile,
                           at_before = static_cast<std::ptrdiff_t>(i) * Strip;
      const std::array<int, 2> other{difference<Strip>(was_above + at_before, below + at),
                                     difference<Strip>(above + at, was_above + kRow + at_before)};
      // A picture that moves by a row fits the one before everywhere: a seam is where the step is its own.
      const bool may_be_seam = is_clearly_less<Strip>(std::max(over[i], under[i]), own[i]);
      for (std::size_t side = 0; side < 2; ++side) {
        if (may_be_seam && is_clearly_less<Strip>(other[side], own[i])) ++votes[side];
        if (is_clearly_less<Strip>(own[i], other[side])) --votes[side];
      }
    }
    for (std::size_t side = 0; side < 2; ++side) {
      float& collected = collected_[side][static_cast<std::size_t>(y)];
      collected =
          std::clamp(kKept * collected + static_cast<float>(votes[side]), kLeastCollected, kMostCollected);
      signs.is_lasting = signs.is_lasting || collected >= kLasting;
      if (votes[side] <= signs.votes) continue;
      signs.votes = votes[side];
      signs.row = y;
      signs.lower_is_older = side == 0;
    }
  }
  for (std::size_t y = 0; y < rows; ++y)
    for (std::size_t i = 0; i < kTiles; ++i)
      std::memcpy(before_.data() + y * kRow + i * Strip,
                  picture.row(static_cast<int>(y)) + inset + static_cast<std::ptrdiff_t>(i) * tile, Strip);
  return signs;
}

}  // namespace arthronaut::pipeline
