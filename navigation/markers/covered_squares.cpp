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
               std::vector<char>& is_used, Sides& sides) {
  const double tight = kOnOutline * size;
  const int count = static_cast<int>(outline.size());
  is_used.assign(outline.size(), 0);
  int lines = 0;
  for (; lines < kMaxLines; ++lines) {
    Side best;
    for (int trial = 0; trial < kOutlineTrials; ++trial) {
      const int i = trial * 7919 % count, j = (i + 2 + trial * 104729 % std::max(1, count / 6)) % count;
      if (is_used[i] || is_used[j]) continue;
      const Eigen::Vector2d way = outline[j] - outline[i];
      if (way.norm() < 0.12 * size || way.norm() > 0.9 * size) continue;
      const Line line{outline[i], way.normalized()};
      int on = 0;
      for (int k = 0; k < count; ++k) on += !is_used[k] && line.distance(outline[k]) < tight;
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
      outline_.clear();
      trace_outline(static_cast<int>(label), region, camera);
      combine_sides(camera);
      FoundSquare square;
      if (outline_square(static_cast<int>(label), region, camera, square) && squares_.size() < kMaxSquares)
        squares_.push_back(square);
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
  const int lines = find_sides(outline_, size, 0.5 * (low + high), is_used_, sides);
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
  best.add_to(squares_);
  closed.add_to(squares_);
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
