#include "navigation/pipeline/frozen_picture.h"

#include <algorithm>
#include <cstdlib>

namespace arthronaut::pipeline {

namespace {

// Measured at 1080p on path-traced arthroscopy (mean difference within the worst tile, grey values). A still
// coded anew: 0 to 0.2 in four frames of five (H.264 and MPEG-4, CRF 15 to 30, 8 Mb/s constant rate), up
// to 5.7 from one key frame to another. The same scene held still under sensor noise and coded at CRF 15 to
// 18: 1.1 and more in every frame. Moving clips: 11 and more, and 90 over 0.3 s.
constexpr double kMostRepeat = 0.3, kLeastRepeat = 0.1;
constexpr double kShareOfNoise = 0.3;
constexpr float kMostDrift = 8;
// A source of 15 pictures a second that is sent 60 times a second repeats three frames in four.
constexpr double kShareOfRepeats = 0.8;
constexpr int kSampledRowsPerTile = 8;
// Half of the tiles show nothing but noise also while the scope moves: the mask, the dark, the out-of-focus.
constexpr double kNoiseQuantile = 0.6;
// Over a second of frames: a codec that refines a frozen picture for a few of them must not pass for a source
// with less noise. (A scene that moves adds to what is seen; the limits above bound what comes of it.)
constexpr double kLearning = 1.0 / 60;

}  // namespace

void FrozenPicture::sample(const camera::GrayView& picture) {
  const int rows = std::min(kRows * kSampledRowsPerTile, picture.height);
  if (picture.width != width_ || picture.height != height_) {
    width_ = picture.width;
    height_ = picture.height;
    row_count_ = rows;
    for (auto* samples : {&now_, &before_, &anchor_})
      samples->assign(static_cast<std::size_t>(rows) * static_cast<std::size_t>(width_), 0);
    step_count_ = 0;
    noise_ = -1;
  }
  for (int i = 0; i < rows; ++i) {
    const std::uint8_t* const row = picture.row((2 * i + 1) * picture.height / (2 * rows));
    std::copy(row, row + width_, now_.data() + static_cast<std::ptrdiff_t>(i) * width_);
  }
}

FrozenPicture::Tiles FrozenPicture::difference(const std::vector<std::uint8_t>& other) const {
  Tiles tiles{};
  for (int row = 0; row < kRows; ++row) {
    const int top = row * row_count_ / kRows, bottom = (row + 1) * row_count_ / kRows;
    for (int column = 0; column < kColumns; ++column) {
      const int left = column * width_ / kColumns, right = (column + 1) * width_ / kColumns;
      if (top == bottom || left == right) continue;
      int sum = 0;
      for (int y = top; y < bottom; ++y) {
        const std::uint8_t* const a = now_.data() + static_cast<std::ptrdiff_t>(y) * width_;
        const std::uint8_t* const b = other.data() + static_cast<std::ptrdiff_t>(y) * width_;
        for (int x = left; x < right; ++x) sum += std::abs(static_cast<int>(a[x]) - b[x]);
      }
      tiles[static_cast<std::size_t>(row * kColumns + column)] =
          static_cast<float>(sum) / static_cast<float>((bottom - top) * (right - left));
    }
  }
  return tiles;
}

void FrozenPicture::learn_noise(Tiles step) {
  auto* const quantile =
      step.begin() + static_cast<std::ptrdiff_t>(kNoiseQuantile * static_cast<double>(step.size()));
  std::nth_element(step.begin(), quantile, step.end());
  noise_ = noise_ < 0 ? *quantile : noise_ + kLearning * (*quantile - noise_);
}

bool FrozenPicture::mostly_repeats(std::int64_t since_ns) const {
  int count = 0, repeats = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(step_count_, kMostFrames); ++i) {
    const Step& step = steps_[(step_count_ - 1 - i) % kMostFrames];
    if (step.timestamp_ns <= since_ns) break;
    ++count;
    repeats += step.repeats ? 1 : 0;
  }
  return count > 0 && repeats >= kShareOfRepeats * count;
}

bool FrozenPicture::observe(const camera::GrayView& picture, std::int64_t timestamp_ns) {
  std::swap(now_, before_);
  sample(picture);
  const bool is_first = step_count_ == 0 || timestamp_ns < last_ns_;
  last_ns_ = timestamp_ns;
  if (is_first) {
    step_count_ = 1;
    steps_[0] = {timestamp_ns, false};
    anchor_ = now_;
    anchor_ns_ = timestamp_ns;
    return false;
  }
  const Tiles step = difference(before_);
  const double noise = noise_ < 0 ? kMostRepeat / kShareOfNoise : noise_;
  const double most_repeat = std::clamp(kShareOfNoise * noise, kLeastRepeat, kMostRepeat);
  const bool repeats = *std::max_element(step.begin(), step.end()) < most_repeat;
  if (!repeats) learn_noise(step);
  steps_[step_count_++ % kMostFrames] = {timestamp_ns, repeats};

  const Tiles drift = difference(anchor_);
  if (*std::max_element(drift.begin(), drift.end()) > kMostDrift) {
    anchor_ = now_;
    anchor_ns_ = timestamp_ns;
    return false;
  }
  const auto window_ns = static_cast<std::int64_t>(1e9 * frozen_after_s_);
  return timestamp_ns - anchor_ns_ >= window_ns && mostly_repeats(timestamp_ns - window_ns);
}

}  // namespace arthronaut::pipeline
