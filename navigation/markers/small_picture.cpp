// The picture that squares are sought in: the view, made small, and its sums.
#include <algorithm>
#include <cstring>
#include <type_traits>

#include "navigation/markers/square_search.h"

namespace arthronaut::markers {
namespace {

// By how much the frame is made smaller for the search: small pictures hold small markers.
constexpr int kShrink = 4, kShrinkSmall = 2;
constexpr int kSmallView = 700;  // in frame pixels

// Down first, then across: so the processor does many columns at a time.
template <int kTimes>
void average_row(const camera::GrayView& frame, int left, int top, int width, std::uint16_t* sums,
                 std::uint8_t* out) {
  const std::uint8_t* rows[kTimes];
  for (int k = 0; k < kTimes; ++k) rows[k] = frame.row(top + k) + left;
  for (int x = 0; x < kTimes * width; ++x) {
    unsigned sum = 0;
    for (int k = 0; k < kTimes; ++k) sum += rows[k][x];
    sums[x] = static_cast<std::uint16_t>(sum);
  }
  // The sums that make one pixel are the parts of a word: one product adds them up in its highest part.
  using Word = std::conditional_t<kTimes == 4, std::uint64_t, std::uint32_t>;
  static_assert(sizeof(Word) == kTimes * sizeof(std::uint16_t) && kTimes * kTimes * 255 < 1 << 16);
  constexpr int kHighest = 16 * (kTimes - 1);
  constexpr Word kOnes = static_cast<Word>(0x0001'0001'0001'0001);
  for (int x = 0; x < width; ++x) {
    Word parts;
    std::memcpy(&parts, sums + kTimes * x, sizeof parts);
    const auto sum = static_cast<unsigned>(static_cast<Word>(parts * kOnes) >> kHighest);
    out[x] = static_cast<std::uint8_t>((sum + kTimes * kTimes / 2) / (kTimes * kTimes));
  }
}

}  // namespace

// The bounding box of the view, four by four pixels to one.
void SquareSearch::look_at(const camera::GrayView& frame, const camera::CameraModel& camera) {
  int right = frame.width, bottom = frame.height;
  left_ = top_ = 0;
  if (const auto& circle = camera.boundary(); circle.radius_px > 0) {
    left_ = std::clamp(static_cast<int>(circle.center_px.x() - circle.radius_px), 0, frame.width);
    top_ = std::clamp(static_cast<int>(circle.center_px.y() - circle.radius_px), 0, frame.height);
    right = std::clamp(static_cast<int>(circle.center_px.x() + circle.radius_px) + 1, left_, frame.width);
    bottom = std::clamp(static_cast<int>(circle.center_px.y() + circle.radius_px) + 1, top_, frame.height);
  }
  shrink_ = std::max(right - left_, bottom - top_) > kSmallView ? kShrink : kShrinkSmall;
  width_ = (right - left_) / shrink_;
  height_ = (bottom - top_) / shrink_;
  reserve(frame.width / shrink_, frame.height / shrink_);
  const std::size_t count = static_cast<std::size_t>(width_) * height_;
  small_.resize(count);
  column_sums_.resize(static_cast<std::size_t>(width_) * shrink_);
  dark_.resize(count);
  labels_.resize(count);
  sums_.resize((static_cast<std::size_t>(width_) + 1) * (height_ + 1));
  first_.resize(std::max(width_, height_));
  last_.resize(std::max(width_, height_));
  white_pixels_ = 0;
  sums_are_ = Sums::None;
  for (int y = 0; y < height_; ++y) {
    std::uint8_t* out = &small_[static_cast<std::size_t>(y) * width_];
    shrink_ == kShrink
        ? average_row<kShrink>(frame, left_, top_ + shrink_ * y, width_, column_sums_.data(), out)
        : average_row<kShrinkSmall>(frame, left_, top_ + shrink_ * y, width_, column_sums_.data(), out);
    for (int x = 0; x < width_; ++x) white_pixels_ += out[x] >= kWhite;
  }
}

// The view moves and grows within the frame, and what it shows is another thing in every frame: memory for
// the most there can be, which costs nothing until it is touched.
void SquareSearch::reserve(int width, int height) {
  const std::size_t count = static_cast<std::size_t>(width) * height, most_regions = (count + 1) / 2;
  for (auto* bytes : {&small_, &dark_, &was_dark_}) bytes->reserve(count);
  column_sums_.reserve(static_cast<std::size_t>(width) * shrink_);
  sums_.reserve((static_cast<std::size_t>(width) + 1) * (height + 1));
  labels_.reserve(count);
  joined_.parents.reserve(most_regions);
  joined_.runs.reserve(most_regions + height);
  regions_.reserve(most_regions);
  first_.reserve(std::max(width, height));
  last_.reserve(std::max(width, height));
  // Two points a row and two a column; two regions at a time.
  const std::size_t most_points = 4 * static_cast<std::size_t>(width + height);
  outline_.reserve(most_points);
  hull_.reserve(most_points + 1);
  points_.is_used.reserve(most_points);
  points_.xs.reserve(most_points);
  points_.ys.reserve(most_points);
}

// Without white: what was before it in the row stands in for a white pixel.
void SquareSearch::sum_rows(bool without_white) {
  const Sums wanted = without_white ? Sums::WithoutWhite : Sums::OfAll;
  if (width_ <= 0 || sums_are_ == wanted) return;
  sums_are_ = wanted;
  std::fill_n(sums_.begin(), width_ + 1, 0U);
  for (int y = 0; y < height_; ++y) {
    const std::uint8_t* in = &small_[static_cast<std::size_t>(y) * width_];
    const std::uint32_t* above = &sums_[static_cast<std::size_t>(y) * (width_ + 1)];
    std::uint32_t* here = &sums_[static_cast<std::size_t>(y + 1) * (width_ + 1)];
    std::uint32_t row_sum = 0, last = 0;
    here[0] = 0;
    if (!without_white) {
      for (int x = 0; x < width_; ++x) here[x + 1] = above[x + 1] + (row_sum += in[x]);
      continue;
    }
    for (int x = 0; x < width_; ++x) {
      if (in[x] < kWhite) last = in[x];
      row_sum += last;
      here[x + 1] = above[x + 1] + row_sum;
    }
  }
}

}  // namespace arthronaut::markers
