#include "navigation/pipeline/frozen_picture.h"

#include <algorithm>
#include <cmath>
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
// A dark or plain picture with the noise of a sensor without light; a lit scope has a rim and highlights.
constexpr int kMostSpreadOfBlank = 24;
constexpr double kShareOfSpecks = 0.001;
// Two repeats more than the source is used to make: 67 ms at 30 pictures a second. Five, while nothing is
// known of it or it repeats much: one that repeats three frames in four never does that.
constexpr int kRepeatsTooMany = 2, kRepeatsOnEnd = 5;
constexpr std::int64_t kRepeatingFor_ns = 60'000'000;
constexpr std::size_t kKnownAfter = 15;  // frames
constexpr int kSampledRowsPerTile = 8;
// Half of the tiles show nothing but noise also while the scope moves: the mask, the dark, the out-of-focus.
constexpr double kNoiseQuantile = 0.6;
// Over a second of frames: a codec that refines a frozen picture for a few of them must not pass for a source
// with less noise. (A scene that moves adds to what is seen; the limits above bound what comes of it.)
constexpr double kLearning = 1.0 / 60;

// More than the longest row of repeats before the newest one, which has so many. steps: a ring of which
// step_count were written. What a source makes that hangs is no habit.
template <typename Steps>
int repeats_on_end(const Steps& steps, std::size_t step_count, std::size_t in_row) {
  const std::size_t known = std::min(step_count, steps.size());
  if (known < in_row + kKnownAfter) return kRepeatsOnEnd;
  int longest = 0, count = 0;
  for (std::size_t i = in_row; i < known; ++i) {
    if (steps[(step_count - 1 - i) % steps.size()].repeats) {
      ++count;
    } else {
      if (count < kRepeatsOnEnd) longest = std::max(longest, count);
      count = 0;
    }
  }
  return std::min(longest + kRepeatsTooMany, kRepeatsOnEnd);
}

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
    torn_.reset();
    seam_.reset();
    standing_.reset();
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

double FrozenPicture::share_of_repeats(std::int64_t since_ns) const {
  int count = 0, repeats = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(step_count_, kMostFrames); ++i) {
    const Step& step = steps_[(step_count_ - 1 - i) % kMostFrames];
    if (step.timestamp_ns <= since_ns) break;
    ++count;
    repeats += step.repeats ? 1 : 0;
  }
  return count > 0 ? static_cast<double>(repeats) / count : 0;
}

bool FrozenPicture::is_blank() const {
  std::array<int, 256> count{};
  for (const std::uint8_t luma : now_) ++count[luma];
  const auto leave_out = static_cast<int>(kShareOfSpecks * static_cast<double>(now_.size()));
  int low = 0, high = 255;
  for (int left_out = count[0]; left_out <= leave_out && low < 255;)
    left_out += count[static_cast<std::size_t>(++low)];
  for (int left_out = count[255]; left_out <= leave_out && high > 0;)
    left_out += count[static_cast<std::size_t>(--high)];
  return high - low < kMostSpreadOfBlank;
}

bool FrozenPicture::stands_still(std::span<const Eigen::Vector2d> corners_px) const {
  if (corners_px.empty() || row_count_ == 0) return false;
  Eigen::Vector2d least = corners_px[0], most = corners_px[0];
  for (const Eigen::Vector2d& corner : corners_px) {
    least = least.cwiseMin(corner);
    most = most.cwiseMax(corner);
  }
  least = least.cwiseMax(0);
  most = most.cwiseMin(Eigen::Vector2d(width_, height_));
  if (!(least.x() < most.x() && least.y() < most.y())) return false;
  // Sampled row i lies at (i + 1/2) height / rows.
  const double rows_per_px = static_cast<double>(row_count_) / height_;
  return standing_.stand(static_cast<int>(std::ceil(least.y() * rows_per_px - 0.5)),
                         static_cast<int>(std::floor(most.y() * rows_per_px - 0.5)) + 1,
                         static_cast<int>(least.x()), static_cast<int>(most.x()));
}

bool FrozenPicture::observe(const camera::GrayView& picture, std::int64_t timestamp_ns) {
  std::swap(now_, before_);
  sample(picture);
  const bool is_first = step_count_ == 0 || timestamp_ns < last_ns_;
  if (is_first) seam_.reset();
  if (is_first) standing_.reset();
  const PictureSeam::Signs seam = seam_.observe(picture);
  last_ns_ = timestamp_ns;
  signs_ = {};
  signs_.is_blank = is_blank();
  if (is_first) {
    row_ = {0, timestamp_ns};
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
  if (!repeats) standing_.observe(now_, before_, width_, most_repeat);
  if (!repeats) row_ = {0, timestamp_ns};
  row_.count += repeats ? 1 : 0;
  steps_[step_count_++ % kMostFrames] = {timestamp_ns, repeats};

  signs_.is_repeating =
      row_.count >= kRepeatsTooMany && timestamp_ns - row_.since_ns >= kRepeatingFor_ns &&
      row_.count >= repeats_on_end(steps_, step_count_, static_cast<std::size_t>(row_.count));
  signs_.is_torn = torn_.observe(step, seam, height_, timestamp_ns);
  signs_.repeat_share = share_of_repeats(timestamp_ns - 500'000'000);

  const Tiles drift = difference(anchor_);
  if (*std::max_element(drift.begin(), drift.end()) > kMostDrift) {
    anchor_ = now_;
    anchor_ns_ = timestamp_ns;
    return false;
  }
  const auto window_ns = static_cast<std::int64_t>(1e9 * frozen_after_s_);
  return timestamp_ns - anchor_ns_ >= window_ns &&
         share_of_repeats(timestamp_ns - window_ns) >= kShareOfRepeats;
}

}  // namespace arthronaut::pipeline
