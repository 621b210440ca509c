// Squares of which a part is hidden: out of the straight parts of an outline.
#include <algorithm>
#include <cmath>

#include "navigation/markers/outline_lines.h"
#include "navigation/markers/square_search.h"

namespace arthronaut::markers {
namespace {

// Straight parts of the outline of a region of which a part is hidden: how many of them, how many trials
// each, how near a point lies, and the least area of a square that they make, both by the region's length.
constexpr int kMaxLines = 6, kOutlineTrials = 40, kSquaresOfARegion = 3;
constexpr double kOnOutline = 0.015, kMinPart = 0.12;

}  // namespace

void SquareSearch::combine_sides(const camera::CameraModel& camera) {
  if (outline_.size() < 16) return;
  Eigen::Vector2d low = outline_[0], high = outline_[0];
  for (const Eigen::Vector2d& point : outline_) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double size = (high - low).maxCoeff(), tight = kOnOutline * size;
  const int count = static_cast<int>(outline_.size());
  is_used_.assign(outline_.size(), 0);
  struct Side {
    Line line;
    double angle = 0;
    int support = 0;
  };
  std::array<Side, kMaxLines> sides;
  int lines = 0;
  const Eigen::Vector2d middle = 0.5 * (low + high);
  // The straightest part first, then of what is left.
  for (; lines < kMaxLines; ++lines) {
    Side best;
    for (int trial = 0; trial < kOutlineTrials; ++trial) {
      const int i = trial * 7919 % count, j = (i + 2 + trial * 104729 % std::max(1, count / 6)) % count;
      if (is_used_[i] || is_used_[j]) continue;
      const Eigen::Vector2d way = outline_[j] - outline_[i];
      if (way.norm() < 0.12 * size || way.norm() > 0.9 * size) continue;
      const Line line{outline_[i], way.normalized()};
      int on = 0;
      for (int k = 0; k < count; ++k) on += !is_used_[k] && line.distance(outline_[k]) < tight;
      if (on > best.support) best = {line, 0, on};
    }
    if (best.support < std::max(6, count / 16)) break;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (int k = 0; k < count; ++k) {
      if (!is_used_[k] && best.line.distance(outline_[k]) < tight) mean += outline_[k] / best.support;
    }
    for (int k = 0; k < count; ++k) {
      if (is_used_[k] || best.line.distance(outline_[k]) >= tight) continue;
      spread += (outline_[k] - mean) * (outline_[k] - mean).transpose();
      is_used_[k] = 1;
    }
    const double along = 0.5 * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1));
    best.line = {mean, {std::cos(along), std::sin(along)}};
    // Turning from x to y about the region, as its outline does.
    if (cross(best.line.point - middle, best.line.direction) < 0) best.line.direction = -best.line.direction;
    best.angle = std::atan2(best.line.direction.y(), best.line.direction.x());
    sides[lines] = best;
  }
  if (lines < 4) return;
  std::sort(sides.begin(), sides.begin() + lines,
            [](const Side& a, const Side& b) { return a.angle < b.angle; });
  struct Combined {
    FoundSquare square;
    int support = 0;
  };
  std::array<Combined, kSquaresOfARegion> best;
  for (int mask = 0; mask < 1 << lines; ++mask) {
    std::array<int, 4> chosen;
    int n = 0, support = 0;
    for (int k = 0; k < lines && n <= 4; ++k) {
      if (!(mask >> k & 1)) continue;
      if (n < 4) chosen[n] = k;
      ++n;
      support += sides[k].support;
    }
    if (n != 4 || support <= best.back().support) continue;
    std::array<Eigen::Vector2d, 4> quad;
    bool is_square = true;
    for (int corner = 0; corner < 4 && is_square; ++corner) {
      const Line &before = sides[chosen[(corner + 3) % 4]].line, &after = sides[chosen[corner]].line;
      const double turn = cross(before.direction, after.direction);
      is_square = turn > kMinOpening;
      if (is_square)
        quad[corner] =
            before.point + before.direction * (cross(after.point - before.point, after.direction) / turn);
    }
    FoundSquare square;
    if (!is_square || !(area_of(quad) > kMinPart * size * size) || !measure_sides(camera, quad, square))
      continue;
    best.back() = {square, support};
    std::sort(best.begin(), best.end(),
              [](const Combined& a, const Combined& b) { return a.support > b.support; });
  }
  for (const Combined& combined : best) {
    if (combined.support > 0 && squares_.size() < kMaxSquares) squares_.push_back(combined.square);
  }
}

}  // namespace arthronaut::markers
