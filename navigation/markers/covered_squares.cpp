// Squares of which a part is hidden: out of the straight parts of an outline.
#include <algorithm>
#include <cmath>
#include <utility>

#include "navigation/markers/outline_lines.h"
#include "navigation/markers/square_search.h"

namespace arthronaut::markers {
namespace {

// Straight parts of the outline of a region of which a part is hidden: how many of them, how many trials
// each, how near a point lies, and the least area of a square that they make, both by the region's length.
constexpr int kMaxLines = 6, kOutlineTrials = 40, kSquaresOfARegion = 3;
constexpr double kOnOutline = 0.015, kMinPart = 0.12;
// Squares of three sides: one place, or both, for the side that is hidden.
constexpr int kClosedOfARegion = 2;
// Pieces that a highlight leaves of a square, in shrunk pixels: how far it glows to either side, how large
// they are, the longer one of two at least, and how many are looked at in a frame.
constexpr int kGlow = 3, kMinPieceLength = 3, kMinPieceArea = 8, kMinLongerLength = 8, kMostPieceLength = 60,
              kMostPieces = 64;

constexpr int kMinWhitePixels = 4;  // fewer are no highlight on a marker
constexpr int kLeastFilled = 10;    // of the box about a region, one pixel of so many
// What one call finds, and what it looks at, so that no frame takes long; the next call goes on from there.
constexpr std::size_t kSquaresAtATime = 32;
constexpr int kOutlinesAtATime = 64;

struct Side {
  Line line;
  double angle = 0;
  int support = 0;
  double first = 0, last = 0;  // along it: where the outline lies on it
};
using Sides = std::array<Side, kMaxLines>;

// Where a side meets the next one, which turns to the inside.
bool meet(const Line& before, const Line& after, Eigen::Vector2d& corner) {
  const double turn = cross(before.direction, after.direction);
  if (!(turn > kMinOpening)) return false;
  corner = before.point + before.direction * (cross(after.point - before.point, after.direction) / turn);
  return true;
}

// The squares that the most of an outline speaks for.
template <int kCount>
struct BestSquares {
  std::array<FoundSquare, kCount> squares;
  std::array<int, kCount> supports{};

  [[nodiscard]] bool would_take(int support) const { return support > supports.back(); }
  void take(const FoundSquare& square, int support) {
    int at = kCount - 1;
    for (; at > 0 && supports[at - 1] < support; --at) {
      squares[at] = squares[at - 1];
      supports[at] = supports[at - 1];
    }
    squares[at] = square;
    supports[at] = support;
  }
  void add_to(std::vector<FoundSquare>& found) const {
    for (int i = 0; i < kCount && supports[i] > 0 && found.size() < kMaxSquares; ++i)
      found.push_back(squares[i]);
  }
};

// The straightest part first, then of what is left; by their angles. Gives how many there are.
int find_sides(const std::vector<Eigen::Vector2d>& outline, double size, const Eigen::Vector2d& middle,
               OutlinePoints& points, Sides& sides) {
  const double tight = kOnOutline * size;
  auto& [is_used, xs, ys] = points;
  const int count = static_cast<int>(outline.size());
  is_used.assign(outline.size(), 0);
  int lines = 0;
  for (; lines < kMaxLines; ++lines) {
    Side best;
    xs.clear();
    ys.clear();
    for (int k = 0; k < count; ++k) {
      if (is_used[k]) continue;
      xs.push_back(outline[k].x());
      ys.push_back(outline[k].y());
    }
    for (int trial = 0; trial < kOutlineTrials; ++trial) {
      const int i = trial * 7919 % count, j = (i + 2 + trial * 104729 % std::max(1, count / 6)) % count;
      if (is_used[i] || is_used[j]) continue;
      const Eigen::Vector2d way = outline[j] - outline[i];
      if (way.norm() < 0.12 * size || way.norm() > 0.9 * size) continue;
      const Line line{outline[i], way.normalized()};
      const int on = count_near(line, xs, ys, tight, best.support);
      if (on > best.support) {
        best.line = line;
        best.support = on;
      }
    }
    if (best.support < std::max(6, count / 16)) break;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (int k = 0; k < count; ++k) {
      if (!is_used[k] && best.line.distance(outline[k]) < tight) mean += outline[k] / best.support;
    }
    for (int k = 0; k < count; ++k) {
      if (is_used[k] || best.line.distance(outline[k]) >= tight) continue;
      spread += (outline[k] - mean) * (outline[k] - mean).transpose();
      is_used[k] = 1;
    }
    const double along = 0.5 * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1));
    best.line = {mean, {std::cos(along), std::sin(along)}};
    // Turning from x to y about the region, as its outline does.
    if (cross(best.line.point - middle, best.line.direction) < 0) best.line.direction = -best.line.direction;
    for (const Eigen::Vector2d& point : outline) {
      if (best.line.distance(point) >= tight) continue;
      const double at = best.line.direction.dot(point - mean);
      best.first = std::min(best.first, at);
      best.last = std::max(best.last, at);
    }
    best.angle = std::atan2(best.line.direction.y(), best.line.direction.x());
    sides[lines] = best;
  }
  std::sort(sides.begin(), sides.begin() + lines,
            [](const Side& a, const Side& b) { return a.angle < b.angle; });
  return lines;
}

}  // namespace

bool SquareSearch::has_highlight(const FoundSquare& square) const {
  Eigen::Vector2d low = square.corners_px[0], high = low;
  for (const Eigen::Vector2d& corner : square.corners_px) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const auto small = [this](double at, int from) {
    return static_cast<int>(std::floor((at - from) / shrink_));
  };
  const int left = std::max(0, small(low.x(), left_)), right = std::min(width_ - 1, small(high.x(), left_));
  const int top = std::max(0, small(low.y(), top_)), bottom = std::min(height_ - 1, small(high.y(), top_));
  for (int y = top; y <= bottom; ++y) {
    const std::uint8_t* row = &small_[static_cast<std::size_t>(y) * width_];
    for (int x = left; x <= right; ++x) {
      if (row[x] >= kWhite) return true;
    }
  }
  return false;
}

std::span<const FoundSquare> SquareSearch::find_across_highlights(const camera::CameraModel& camera) {
  squares_.clear();
  if (white_pixels_ < kMinWhitePixels) return squares_;
  sum_rows(true);
  find_regions(Contrast::Usual, true);
  if (regions_.empty()) return squares_;
  // White has joined what it lies on, and is no part of its outline.
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    if (labels_[i] < 0 || was_dark_[i]) continue;
    regions_[labels_[i]].has_white = true;
    labels_[i] = -1;
  }
  covered_.outlines = 0;
  const std::size_t first = std::exchange(covered_.next_across, 0);
  for (std::size_t k = 0; k < regions_.size(); ++k) {
    const std::size_t label = (first + k) % regions_.size();
    const Region& region = regions_[label];
    if (!region.has_white || !may_be_square(region, kLeastFilled)) continue;
    if (is_done_or_takes_outline()) {
      covered_.next_across = label;
      break;
    }
    add_squares_of(label, camera);
  }
  return squares_;
}

// Where the picture is white, and one pixel about it: a highlight glows.
void SquareSearch::mark_white_pixels() {
  was_dark_ = dark_;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (small_[static_cast<std::size_t>(y) * width_ + x] < kWhite) continue;
      const int left = std::max(0, x - 1), right = std::min(width_ - 1, x + 1);
      for (int row = std::max(0, y - 1); row <= std::min(height_ - 1, y + 1); ++row)
        std::fill_n(&dark_[static_cast<std::size_t>(row) * width_ + left], right - left + 1, 1);
    }
  }
}

void SquareSearch::add_squares_of(std::size_t label, const camera::CameraModel& camera) {
  outline_.clear();
  trace_outline(static_cast<int>(label), regions_[label], camera);
  combine_sides(camera);
  FoundSquare square;
  if (outline_square(static_cast<int>(label), regions_[label], camera, square) &&
      squares_.size() < kMaxSquares)
    squares_.push_back(square);
}

std::span<const FoundSquare> SquareSearch::find_covered(const camera::CameraModel& camera) {
  const bool has_highlights = white_pixels_ >= kMinWhitePixels;
  sum_rows(has_highlights);
  find_regions(Contrast::Usual);
  if (!has_highlights && covered_.is_at_pieces) start_over();
  covered_.outlines = 0;
  if (!covered_.is_at_pieces) {
    for (std::size_t label = std::exchange(covered_.next, 0); label < regions_.size(); ++label) {
      const Region& region = regions_[label];
      if (!may_be_square(region, kLeastFilled)) continue;
      if (is_done_or_takes_outline()) {
        covered_.next = label;
        return squares_;
      }
      add_squares_of(label, camera);
    }
  }
  covered_.is_at_pieces = has_highlights;
  if (has_highlights) combine_pieces(camera);
  return squares_;
}

bool SquareSearch::is_done_or_takes_outline() {
  return squares_.size() >= kSquaresAtATime || covered_.outlines++ >= kOutlinesAtATime;
}

void SquareSearch::combine_sides(const camera::CameraModel& camera) {
  if (outline_.size() < 16) return;
  Eigen::Vector2d low = outline_[0], high = outline_[0];
  for (const Eigen::Vector2d& point : outline_) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double size = (high - low).maxCoeff(), least_area = kMinPart * size * size;
  Sides sides;
  const int lines = find_sides(outline_, size, 0.5 * (low + high), points_, sides);
  BestSquares<kSquaresOfARegion> best;
  for (int mask = 0; mask < 1 << lines; ++mask) {
    std::array<int, 4> chosen;
    int n = 0, support = 0;
    for (int k = 0; k < lines && n <= 4; ++k) {
      if (!(mask >> k & 1)) continue;
      if (n < 4) chosen[n] = k;
      ++n;
      support += sides[k].support;
    }
    if (n != 4 || !best.would_take(support)) continue;
    std::array<Eigen::Vector2d, 4> quad;
    bool is_square = true;
    for (int corner = 0; corner < 4 && is_square; ++corner)
      is_square = meet(sides[chosen[(corner + 3) % 4]].line, sides[chosen[corner]].line, quad[corner]);
    FoundSquare square;
    if (is_square && area_of(quad) > least_area && measure_sides(camera, quad, square))
      best.take(square, support);
  }
  // A whole side is hidden: it lies where those beside it end, or, since a highlight hides an end, too, as
  // far along both as the longer one is seen.
  BestSquares<kClosedOfARegion> closed;
  const auto close = [&](const Side& before, const Side& side, const Side& after) {
    const int support = before.support + side.support + after.support;
    std::array<Eigen::Vector2d, 4> quad;
    if (!closed.would_take(support) || !meet(before.line, side.line, quad[0]) ||
        !meet(side.line, after.line, quad[1]))
      return;
    const double back = before.line.direction.dot(quad[0] - before.line.point) - before.first;
    const double on = after.last - after.line.direction.dot(quad[1] - after.line.point);
    const double longer = std::max(back, on);
    for (const auto& [left, right] : {std::pair(back, on), std::pair(longer, longer)}) {
      quad[2] = quad[1] + right * after.line.direction;
      quad[3] = quad[0] - left * before.line.direction;
      FoundSquare square;
      if (area_of(quad) > least_area && measure_sides(camera, quad, square)) closed.take(square, support);
    }
  };
  for (int a = 0; a < lines; ++a) {
    for (int b = 0; b < lines; ++b) {
      for (int c = 0; c < lines; ++c) {
        if (a != b && b != c && c != a) close(sides[a], sides[b], sides[c]);
      }
    }
  }
  // Under a highlight two sides that meet may be all that is seen from end to end.
  BestSquares<1> cornered;
  for (int a = 0; a < lines && white_pixels_ >= kMinWhitePixels; ++a) {
    for (int b = 0; b < lines; ++b) {
      const Line &before = sides[a].line, &after = sides[b].line;
      const int support = sides[a].support + sides[b].support;
      std::array<Eigen::Vector2d, 4> quad;
      if (a == b || !cornered.would_take(support) || !meet(before, after, quad[1])) continue;
      const double back = before.direction.dot(quad[1] - before.point) - sides[a].first;
      const double on = sides[b].last - after.direction.dot(quad[1] - after.point);
      if (back <= 0 || on <= 0) continue;
      quad[0] = quad[1] - back * before.direction;
      quad[2] = quad[1] + on * after.direction;
      quad[3] = quad[0] + quad[2] - quad[1];
      FoundSquare square;
      if (area_of(quad) > least_area && measure_sides(camera, quad, square)) cornered.take(square, support);
    }
  }
  best.add_to(squares_);
  closed.add_to(squares_);
  cornered.add_to(squares_);
}

// A highlight cuts the dark of a square into regions: any two that are near may be of one square.
void SquareSearch::combine_pieces(const camera::CameraModel& camera) {
  const auto length_of = [](const Region& region) {
    return 1 + std::max(region.right - region.left, region.bottom - region.top);
  };
  std::array<int, kMostPieces> pieces;
  int count = 0;
  for (std::size_t label = 0; label < regions_.size() && count < kMostPieces; ++label) {
    const Region& region = regions_[label];
    const int across = region.right - region.left, down = region.bottom - region.top;
    if (std::max(across, down) < kMostPieceLength && std::min(across, down) + 1 >= kMinPieceLength &&
        region.area >= kMinPieceArea)
      pieces[count++] = static_cast<int>(label);
  }
  const std::size_t first = std::exchange(covered_.next, 0);
  std::size_t pair = 0;
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < i; ++k) {
      if (pair++ < first) continue;
      const Region &a = regions_[pieces[i]], &b = regions_[pieces[k]];
      const int apart = std::max({a.left - b.right, b.left - a.right, a.top - b.bottom, b.top - a.bottom});
      if (apart > 2 * kGlow || std::max(length_of(a), length_of(b)) < kMinLongerLength) continue;
      if (is_done_or_takes_outline()) {
        covered_.next = pair - 1;
        return;
      }
      outline_.clear();
      trace_outline(pieces[i], a, camera);
      trace_outline(pieces[k], b, camera);
      combine_sides(camera);
    }
  }
  covered_.is_at_pieces = false;
}

}  // namespace arthronaut::markers
