#include "navigation/markers/corner_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "navigation/markers/cell_light.h"

namespace arthronaut::markers {
namespace {

using Eigen::Vector2f;

// All lengths in pixels of the small picture.
constexpr int kRing = 16, kRadius = 3;
constexpr int kRingX[kRing] = {0, 1, 2, 3, 3, 3, 2, 1, 0, -1, -2, -3, -3, -3, -2, -1};
constexpr int kRingY[kRing] = {-3, -3, -2, -1, 0, 1, 2, 3, 3, 3, 2, 1, 0, -1, -2, -3};
constexpr int kLeastDark = 3, kMostDark = 6;  // of the ring: 60 to 135 degrees
constexpr int kMinStep = 30;                  // grey levels from dark to bright
constexpr int kMostTraced = 90, kMinTraced = 6, kMissed = 2;
constexpr float kMinOpening = 0.6F;  // sine of the angle between the sides
constexpr float kMeetNear = 2.5F;    // they meet so near to where the corner was seen
constexpr float kSameCorner = 1.5F;
constexpr int kCornersAtATime = 32;
// Lengths that are tried: from where a side is seen no more, in such steps.
constexpr float kShorter = 0.94F, kLonger = 1.1F, kMostTimes = 3.2F;
constexpr float kMinLength = 15, kMostLength = 110, kMostRatio = 2.2F;
// Of the range between dark and bright, in grey levels.
constexpr float kDarkBelow = 0.4F, kBrightAbove = 0.62F;
constexpr int kMinInside = 7, kMaxOpposite = 3, kMinAround = 19;
constexpr double kMinScore = 46;
constexpr std::size_t kOfEach = 2, kMostPatterns = 200;           // four turns of each code
constexpr std::size_t kLikelyCorners = 256, kLikelyWidth = 4096;  // memory set aside
constexpr int kCells = 6;
constexpr double kBeside = 0.35;  // of a side: what is taken reaches so far beyond its corners

float sample(const camera::GrayView& view, const Vector2f& at) {
  const float x = std::clamp(at.x(), 0.0F, static_cast<float>(view.width) - 1.001F),
              y = std::clamp(at.y(), 0.0F, static_cast<float>(view.height) - 1.001F);
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const float right = x - static_cast<float>(column), below = y - static_cast<float>(row);
  const std::uint8_t* upper = view.row(row) + column;
  const std::uint8_t* lower = upper + view.stride;
  const auto mix = [](float a, float b, float share) { return a + share * (b - a); };
  return mix(mix(upper[0], upper[1], right), mix(lower[0], lower[1], right), below);
}

struct Traced {
  Vector2f point, along;
  float seen_px = 0;
};

// Follows a straight edge from a corner on; `to_dark` is across it.
bool trace(const camera::GrayView& view, const Vector2f& from, const Vector2f& along, const Vector2f& to_dark,
           float middle, Traced& side) {
  float n = 0, sum_s = 0, sum_o = 0, sum_ss = 0, sum_so = 0, offset = 0, slope = 0;
  int missed = 0, last = 0;
  for (int s = 2; s <= kMostTraced && missed < kMissed; ++s) {
    const auto way = static_cast<float>(s);
    const float expected = offset + slope * way;
    const float reach = n < 4 ? 0.7F + 0.15F * way : 1.0F;
    float best = 1e9F, before = sample(view, from + way * along + (expected - 2) * to_dark);
    for (int k = -1; k <= 2; ++k) {
      const float after = sample(view, from + way * along + (expected + static_cast<float>(k)) * to_dark);
      if (before >= middle && after < middle) {
        const float at = static_cast<float>(k) - 1 + (before - middle) / (before - after);
        if (std::abs(at) < std::abs(best)) best = at;
      }
      before = after;
    }
    if (std::abs(best) > reach) {
      ++missed;
      continue;
    }
    missed = 0;
    last = s;
    best += expected;
    n += 1;
    sum_s += way;
    sum_o += best;
    sum_ss += way * way;
    sum_so += way * best;
    const float spread = n * sum_ss - sum_s * sum_s;
    if (n >= 3 && spread > 0) {
      slope = (n * sum_so - sum_s * sum_o) / spread;
      offset = (sum_o - slope * sum_s) / n;
    } else {
      offset = sum_o / n;
    }
  }
  if (n < kMinTraced - 1) return false;
  side.point = from + offset * to_dark;
  side.along = (along + slope * to_dark).normalized();
  side.seen_px = static_cast<float>(last);
  return true;
}

float cross(const Vector2f& a, const Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

CornerSearch::CornerSearch() {
  patterns_.reserve(kMostPatterns);
  found_.reserve(kOfEach * kMostPatterns / 4);
  corners_.reserve(kLikelyCorners);
  is_likely_.reserve(kLikelyWidth);
}

std::span<const SupposedSquare> CornerSearch::find(const SquareSearch::SmallPicture& picture,
                                                   const camera::CameraModel& camera,
                                                   std::span<const MarkerCode> codes,
                                                   std::span<const char> is_sought,
                                                   std::span<const Corners> taken) {
  found_.clear();
  patterns_.clear();
  corners_.clear();
  if (codes.empty() || codes.front().cells != kCells) return found_;
  cells_ = codes.front().cells;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    for (int turn = 0; is_sought[i] && turn < 4 && patterns_.size() < kMostPatterns; ++turn) {
      Pattern pattern{i, turn, 0};
      for (int bit = 0; bit < (cells_ + 2) * (cells_ + 2); ++bit) {
        const int row = bit / (cells_ + 2) - 1, column = bit % (cells_ + 2) - 1;
        bool is_bright = row < 0 || column < 0 || row >= cells_ || column >= cells_;
        if (!is_bright) {
          const int there = turned_cell(row, column, (4 - turn) % 4, cells_);
          is_bright = codes[i].is_bright(there / cells_, there % cells_);
        }
        pattern.bright |= static_cast<std::uint64_t>(is_bright) << bit;
      }
      patterns_.push_back(pattern);
    }
  }
  const camera::GrayView& view = picture.view;
  const int rows = view.height - 2 * kRadius;
  if (patterns_.empty() || rows <= 0) return found_;
  const int first_row = next_row_ % rows;
  next_row_ = 0;
  const auto is_taken = [&](int x, int y) {
    const double middle = 0.5 * (picture.times - 1);
    const Eigen::Vector2d at(picture.left + picture.times * x + middle,
                             picture.top + picture.times * y + middle);
    return std::any_of(taken.begin(), taken.end(), [&](const Corners& corners) {
      for (int i = 0; i < 4; ++i) {
        const Eigen::Vector2d side = corners[(i + 1) % 4] - corners[i],
                              next = corners[(i + 2) % 4] - corners[i];
        const Eigen::Vector2d to = at - corners[i];
        const double depth = side.x() * next.y() - side.y() * next.x(),
                     in = side.x() * to.y() - side.y() * to.x();
        if (in < -kBeside * depth) return false;
      }
      return true;
    });
  };
  for (int k = 0; k < rows; ++k) {
    const int y = kRadius + (first_row + k) % rows;
    mark_likely(view, y);
    const auto next_likely = [&](int x) {
      const void* next =
          std::memchr(&is_likely_[static_cast<std::size_t>(x)], 1, static_cast<std::size_t>(view.width - x));
      return next ? static_cast<int>(static_cast<const std::uint8_t*>(next) - is_likely_.data()) : view.width;
    };
    for (int x = next_likely(0); x < view.width; x = next_likely(x + 1)) {
      const Vector2f here(static_cast<float>(x), static_cast<float>(y));
      Corner corner;
      if (std::any_of(corners_.begin(), corners_.end(),
                      [&](const Vector2f& c) { return (c - here).squaredNorm() < 9; }) ||
          is_taken(x, y) || !measure_corner(view, x, y, corner))
        continue;
      if (std::any_of(corners_.begin(), corners_.end(), [&](const Vector2f& c) {
            return (c - corner.at).squaredNorm() < kSameCorner * kSameCorner;
          }))
        continue;
      corners_.push_back(corner.at);
      try_codes(picture, camera, corner);
    }
    if (corners_.size() >= kCornersAtATime) {
      next_row_ = y + 1 - kRadius;
      break;
    }
  }
  std::sort(found_.begin(), found_.end(), [](const SupposedSquare& a, const SupposedSquare& b) {
    return a.score > b.score || (a.score == b.score && a.index < b.index);
  });
  return found_;
}

// Of eight places about a corner one to three are dark, side by side, and something next to it is.
void CornerSearch::mark_likely(const camera::GrayView& view, int y) {
  is_likely_.assign(static_cast<std::size_t>(view.width) + 1, 0);
  const std::uint8_t *up = view.row(y - 3), *upper = view.row(y - 2), *above = view.row(y - 1),
                     *row = view.row(y), *below = view.row(y + 1), *lower = view.row(y + 2),
                     *down = view.row(y + 3);
  std::uint8_t* out = is_likely_.data();
  const int end = view.width - kRadius;
  for (int x = kRadius; x < end; ++x) {
    const std::uint8_t n = up[x], ne = upper[x + 2], e = row[x + 3], se = lower[x + 2], s = down[x],
                       sw = lower[x - 2], w = row[x - 3], nw = upper[x - 2];
    const std::uint8_t low =
        std::min(std::min(std::min(n, ne), std::min(e, se)), std::min(std::min(s, sw), std::min(w, nw)));
    const std::uint8_t high =
        std::max(std::max(std::max(n, ne), std::max(e, se)), std::max(std::max(s, sw), std::max(w, nw)));
    const std::uint8_t near =
        std::min(std::min(std::min(above[x], below[x]), std::min(row[x - 1], row[x + 1])), row[x]);
    const auto middle = static_cast<std::uint8_t>((low + high) / 2);
    const std::uint8_t across = (std::max(n, s) < middle) | (std::max(ne, sw) < middle) |
                                (std::max(e, w) < middle) | (std::max(se, nw) < middle);
    const auto dark = static_cast<std::uint8_t>((n < middle) + (ne < middle) + (e < middle) + (se < middle) +
                                                (s < middle) + (sw < middle) + (w < middle) + (nw < middle));
    out[x] =
        (static_cast<std::uint8_t>(high - low) >= kMinStep) & (near < middle) & (across == 0) & (dark <= 3);
  }
}

bool CornerSearch::measure_corner(const camera::GrayView& view, int x, int y, Corner& corner) const {
  std::array<float, kRing> grey;
  float low = 255, high = 0;
  for (int i = 0; i < kRing; ++i) {
    grey[i] = view.row(y + kRingY[i])[x + kRingX[i]];
    low = std::min(low, grey[i]);
    high = std::max(high, grey[i]);
  }
  const float middle = 0.5F * (low + high);
  if (high - low < kMinStep) return false;
  unsigned dark = 0;
  for (int i = 0; i < kRing; ++i) dark |= static_cast<unsigned>(grey[i] < middle) << i;
  const unsigned changes = dark ^ ((dark << 1 | dark >> (kRing - 1)) & 0xFFFFU);
  const int count = std::popcount(dark);
  if (std::popcount(changes) != 2 || count < kLeastDark || count > kMostDark) return false;
  // Where bright turns to dark, clockwise, and back.
  std::array<Vector2f, 2> toward;
  for (int i = 0; i < kRing; ++i) {
    if (!(changes >> i & 1U)) continue;
    const int before = (i + kRing - 1) % kRing;
    const float share = (grey[before] - middle) / (grey[before] - grey[i]);
    const Vector2f a(static_cast<float>(kRingX[before]), static_cast<float>(kRingY[before])),
        b(static_cast<float>(kRingX[i]), static_cast<float>(kRingY[i]));
    toward[dark >> i & 1U ? 0 : 1] = (a + share * (b - a)).normalized();
  }
  const Vector2f here(static_cast<float>(x), static_cast<float>(y));
  if (sample(view, here + 1.5F * (toward[0] + toward[1]).normalized()) >= middle) return false;
  std::array<Traced, 2> sides;
  const auto clockwise = [](const Vector2f& v) { return Vector2f(-v.y(), v.x()); };
  if (!trace(view, here, toward[0], clockwise(toward[0]), middle, sides[0]) ||
      !trace(view, here, toward[1], -clockwise(toward[1]), middle, sides[1]))
    return false;
  const float turn = cross(sides[0].along, sides[1].along);
  if (turn < kMinOpening) return false;
  corner.at = sides[0].point + cross(sides[1].point - sides[0].point, sides[1].along) / turn * sides[0].along;
  if ((corner.at - here).norm() > kMeetNear) return false;
  for (int k = 0; k < 2; ++k) {
    corner.along[k] = sides[k].along;
    corner.seen_px[k] = sides[k].seen_px - sides[k].along.dot(corner.at - here);
  }
  float dark_sum = 0, bright_sum = 0;
  for (int i = 0; i < kRing; ++i) (dark >> i & 1U ? dark_sum : bright_sum) += grey[i];
  corner.dark = dark_sum / static_cast<float>(count);
  corner.bright = bright_sum / static_cast<float>(kRing - count);
  return true;
}

void CornerSearch::try_codes(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
                             const Corner& corner) {
  const camera::GrayView& view = picture.view;
  const float range = corner.bright - corner.dark;
  const float dark_below = corner.dark + kDarkBelow * range,
              bright_above = corner.bright - (1 - kBrightAbove) * range;
  const float white = corner.bright > SquareSearch::kWhite - 15 ? 256.0F : SquareSearch::kWhite;
  const int wide = cells_ + 2;
  std::uint64_t inside = 0, margin = ~std::uint64_t{0};
  for (int row = 1; row + 1 < cells_; ++row) {
    for (int column = 1; column + 1 < cells_; ++column)
      inside |= std::uint64_t{1} << ((row + 1) * wide + column + 1);
  }
  for (int row = 0; row < cells_; ++row) {
    for (int column = 0; column < cells_; ++column)
      margin &= ~(std::uint64_t{1} << ((row + 1) * wide + column + 1));
  }
  const std::uint64_t border = ~(inside | margin);
  struct Best {
    double score = 0;
    float first = 0, second = 0;
  };
  std::array<Best, kMostPatterns> best;
  const auto least = [&](int k) { return std::max(kMinLength, kShorter * corner.seen_px[k]); };
  const auto most = [&](int k) {
    return std::min(kMostLength, std::max(2 * kMinLength, kMostTimes * corner.seen_px[k]));
  };
  for (float first = least(0); first <= most(0); first *= kLonger) {
    for (float second = least(1); second <= most(1); second *= kLonger) {
      if (first > kMostRatio * second || second > kMostRatio * first) continue;
      const Vector2f across = first / static_cast<float>(cells_) * corner.along[0],
                     down = second / static_cast<float>(cells_) * corner.along[1];
      std::uint64_t dark = 0, bright = 0;
      for (int row = 0; row < wide; ++row) {
        Vector2f at = corner.at + (static_cast<float>(row) - 0.5F) * down - 0.5F * across;
        for (int column = 0; column < wide; ++column, at += across) {
          const int x = static_cast<int>(at.x() + 0.5F), y = static_cast<int>(at.y() + 0.5F);
          if (x < 0 || y < 0 || x >= view.width || y >= view.height) continue;
          const float grey = view.row(y)[x];
          const int bit = row * wide + column;
          dark |= static_cast<std::uint64_t>(grey < dark_below) << bit;
          bright |= static_cast<std::uint64_t>(grey > bright_above && grey < white) << bit;
        }
      }
      // Border and margin are alike of all codes.
      if (std::popcount((dark & border) | (bright & margin)) < kMinAround) continue;
      for (std::size_t p = 0; p < patterns_.size(); ++p) {
        const std::uint64_t code = patterns_[p].bright;
        const std::uint64_t agrees = (dark & ~code) | (bright & code),
                            opposite = (dark & code) | (bright & ~code);
        const int in = std::popcount(agrees & inside), against = std::popcount(opposite & inside),
                  all = std::popcount(agrees);
        if (in < kMinInside || against > kMaxOpposite) continue;
        const double score = all + in - 3 * against - 0.5 * std::popcount(opposite & ~inside);
        if (score >= kMinScore && score > best[p].score) best[p] = {score, first, second};
      }
    }
  }
  for (std::size_t p = 0; p < patterns_.size(); ++p) {
    if (best[p].score > 0)
      take(picture, camera, corner, patterns_[p], best[p].score, best[p].first, best[p].second);
  }
}

void CornerSearch::take(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
                        const Corner& corner, const Pattern& pattern, double score, float first_px,
                        float second_px) {
  std::size_t of_it = 0, worst = found_.size();
  for (std::size_t i = 0; i < found_.size(); ++i) {
    if (found_[i].index != pattern.index) continue;
    ++of_it;
    if (worst == found_.size() || found_[i].score < found_[worst].score) worst = i;
  }
  if (of_it >= kOfEach && found_[worst].score >= score) return;
  SupposedSquare supposed{{}, pattern.index, pattern.turn, score};
  const Vector2f first = first_px * corner.along[0], second = second_px * corner.along[1];
  const std::array<Vector2f, 4> corners = {corner.at, corner.at + first, corner.at + first + second,
                                           corner.at + second};
  for (int i = 0; i < 4; ++i) {
    const double middle = 0.5 * (picture.times - 1);
    const Eigen::Vector2d pixel = Eigen::Vector2d(picture.left + middle, picture.top + middle) +
                                  picture.times * corners[i].cast<double>();
    const auto tangent = camera.undistort(pixel);
    if (!tangent) return;
    supposed.square.corners_px[i] = pixel;
    supposed.square.tangent[i] = *tangent;
  }
  supposed.square.longest_side_px = picture.times * std::max(first_px, second_px);
  if (of_it >= kOfEach)
    found_[worst] = supposed;
  else
    found_.push_back(supposed);
}

}  // namespace arthronaut::markers
