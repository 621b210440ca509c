#include "navigation/pipeline/frozen_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace arthronaut::pipeline {

namespace {

// Of moving clips a tile differs by 11 and more from one picture to the next, and by 90 over 0.3 s; a still
// that is coded anew by up to 5.7 (see repeated_pictures.cpp).
constexpr float kMostDrift = 8;
// A source of 15 pictures a second that is sent 60 times a second repeats three frames in four.
constexpr double kShareOfRepeats = 0.8;
// Half a second may pass until repeats are told, and some of it is the way of the picture that tells.
constexpr std::int64_t kCounted_ns = 400'000'000;
// A dark or plain picture with the noise of a sensor without light; a lit scope has a rim and highlights.
constexpr int kMostSpreadOfBlank = 24;
constexpr double kShareOfSpecks = 0.001;
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
    repeated_.reset();
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
  const bool is_first = !repeated_.has_begun() || timestamp_ns < last_ns_;
  if (is_first) seam_.reset();
  if (is_first) standing_.reset();
  const PictureSeam::Signs seam = seam_.observe(picture);
  last_ns_ = timestamp_ns;
  signs_ = {};
  signs_.is_blank = is_blank();
  if (is_first) {
    repeated_.begin(timestamp_ns);
    is_frozen_ = false;
    anchor_ = now_;
    anchor_ns_ = timestamp_ns;
    return false;
  }
  const Tiles step = difference(before_);
  const bool repeats = repeated_.observe(*std::max_element(step.begin(), step.end()), noise_, timestamp_ns);
  if (!repeats && !repeated_.may_be_refined()) learn_noise(step);
  if (!repeats) standing_.observe(now_, before_, width_, repeated_.most_repeat(noise_));
  signs_.is_repeating = repeated_.is_suspected();
  signs_.is_torn = torn_.observe(step, seam, height_, timestamp_ns);
  signs_.repeat_share = repeated_.share(timestamp_ns - kCounted_ns);
  signs_.shown_for_ns = repeated_.shown_for_ns();

  const Tiles drift = difference(anchor_);
  if (*std::max_element(drift.begin(), drift.end()) > kMostDrift) {
    anchor_ = now_;
    anchor_ns_ = timestamp_ns;
    is_frozen_ = false;
    return false;
  }
  const auto window_ns = static_cast<std::int64_t>(1e9 * frozen_after_s_);
  const bool stands = timestamp_ns - anchor_ns_ >= window_ns &&
                      repeated_.hanging_share(timestamp_ns - window_ns) >= kShareOfRepeats;
  // A key frame of the picture that hangs is no end of it.
  is_frozen_ = stands || (is_frozen_ && repeated_.is_suspected());
  return is_frozen_;
}

}  // namespace arthronaut::pipeline
