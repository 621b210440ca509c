#include "navigation/markers/square_search.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "navigation/markers/outline_lines.h"

namespace arthronaut::markers {
namespace {

// In shrunk pixels.
constexpr int kMinSide = 8;
constexpr int kRadius = 14;
constexpr int kLeastFilled = 6;  // of the box about a region, one pixel of so many
// A pixel is dark below this share of its neighbourhood's mean (in grey levels, so after the camera's gamma).
constexpr int kDarkPercent = 84, kDeepPercent = 66, kFaintPercent = 92;
constexpr int dark_percent(Contrast contrast) {
  if (contrast == Contrast::Deep) return kDeepPercent;
  return contrast == Contrast::Faint ? kFaintPercent : kDarkPercent;
}
constexpr int kMinMean = 8;
constexpr double kMinFill = 0.6;  // hull / quadrilateral
constexpr double kMaxSideRatio = 5;
// Of the side's length: what may belong to a side, and what lies on it.
constexpr double kNearSide = 0.25, kOnLine = 0.02;
constexpr int kLineTrials = 40, kMaxSidePoints = 512;

// From x on the first of the bytes, all 0 or 1, that is not this one; the end where there is none.
int next_unlike(const std::uint8_t* bytes, int x, int end, std::uint8_t value) {
  std::uint64_t alike, word;
  std::memset(&alike, value, sizeof alike);
  for (; x + static_cast<int>(sizeof word) <= end; x += sizeof word) {
    std::memcpy(&word, bytes + x, sizeof word);
    if (word != alike) break;
  }
  while (x < end && bytes[x] == value) ++x;
  return x;
}

// Removes the edge whose neighbours, prolonged until they meet, add the least area; false when no edge can
// go. So a rounded or covered corner is restored.
bool drop_cheapest_edge(std::vector<Eigen::Vector2d>& polygon) {
  const std::size_t n = polygon.size();
  double cheapest = 1e300;
  std::size_t drop = n;
  Eigen::Vector2d meeting = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &before = polygon[(i + n - 1) % n], &a = polygon[i], &b = polygon[(i + 1) % n],
                          &after = polygon[(i + 2) % n];
    const Eigen::Vector2d in = a - before, out = after - b;
    const double turn = cross(in, out);
    if (turn <= 1e-12 * in.norm() * out.norm()) continue;  // they part, or run back
    const double along = cross(b - a, out) / turn;
    if (along < 0) continue;
    const Eigen::Vector2d point = a + along * in;
    const double added = 0.5 * std::abs(cross(point - a, b - a));
    if (added < cheapest) {
      cheapest = added;
      drop = i;
      meeting = point;
    }
  }
  if (drop == n) return false;
  polygon[drop] = meeting;
  polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>((drop + 1) % n));
  return true;
}

}  // namespace

std::span<const FoundSquare> SquareSearch::find(const camera::CameraModel& camera, Contrast contrast) {
  sum_rows(false);
  find_regions(contrast);
  for (std::size_t label = 0; label < regions_.size() && squares_.size() < kMaxSquares; ++label) {
    FoundSquare square;
    if (may_be_square(regions_[label], kLeastFilled) &&
        outline_square(static_cast<int>(label), regions_[label], camera, square))
      squares_.push_back(square);
  }
  return squares_;
}

void SquareSearch::find_regions(Contrast contrast, bool across_white) {
  squares_.clear();
  squares_.reserve(kMaxSquares);
  regions_.clear();
  if (width_ < 2 * kMinSide || height_ < 2 * kMinSide) return;
  mark_dark_pixels(kRadius, dark_percent(contrast));
  if (across_white) mark_white_pixels();
  label_regions();
}

bool SquareSearch::may_be_square(const Region& region, int least_filled) const {
  const int across = region.right - region.left + 1, down = region.bottom - region.top + 1;
  return std::min(across, down) >= kMinSide / 2 && std::max(across, down) >= kMinSide &&
         across <= width_ * 9 / 10 && down <= height_ * 9 / 10 && region.area >= across * down / least_filled;
}

void SquareSearch::mark_dark_pixels(int radius, int percent) {
  const int common = std::gcd(percent, 100), parts = percent / common, all_parts = 100 / common;
  const int inner_first = std::min(radius, width_), inner_end = std::max(inner_first, width_ - radius);
  for (int y = 0; y < height_; ++y) {
    const int y0 = std::max(0, y - radius), y1 = std::min(height_, y + radius + 1);
    const std::uint32_t* upper = &sums_[static_cast<std::size_t>(y0) * (width_ + 1)];
    const std::uint32_t* lower = &sums_[static_cast<std::size_t>(y1) * (width_ + 1)];
    const std::uint8_t* in = &small_[static_cast<std::size_t>(y) * width_];
    std::uint8_t* out = &dark_[static_cast<std::size_t>(y) * width_];
    // What is compared is whole numbers below 2^24, which floats hold exactly and processors multiply
    // quickly.
    const auto mark = [&](int x, int x0, int x1, int area) {
      const int sum = static_cast<int>(lower[x1] - lower[x0] - upper[x1] + upper[x0]);
      out[x] = (static_cast<float>(in[x]) * static_cast<float>(area * all_parts) <
                static_cast<float>(sum) * static_cast<float>(parts)) &
               (sum > kMinMean * area);
    };
    const auto mark_near_border = [&](int x) {
      const int x0 = std::max(0, x - radius), x1 = std::min(width_, x + radius + 1);
      mark(x, x0, x1, (y1 - y0) * (x1 - x0));
    };
    for (int x = 0; x < inner_first; ++x) mark_near_border(x);
    // One area for all, so that several are done at a time.
    const int area = (y1 - y0) * (2 * radius + 1);
    for (int x = inner_first; x < inner_end; ++x) mark(x, x - radius, x + radius + 1, area);
    for (int x = inner_end; x < width_; ++x) mark_near_border(x);
  }
}

// Four-connected regions by union-find of the rows' runs: the eight-connected would run across the corners of
// bright cells to the outside. They are in the order of their first pixels.
void SquareSearch::label_regions() {
  auto& [runs, parents] = joined_;
  parents.clear();
  runs.clear();
  const auto root_of = [&parents = parents](int label) {
    while (parents[label] != label) label = parents[label] = parents[parents[label]];
    return label;
  };
  std::size_t above = 0, above_end = 0;  // the runs of the row before
  for (int y = 0; y < height_; ++y) {
    const std::uint8_t* dark = &dark_[static_cast<std::size_t>(y) * width_];
    for (int x = next_unlike(dark, 0, width_, 0); x < width_;) {
      Run run{y, x, next_unlike(dark, x, width_, 1), -1};
      while (above < above_end && runs[above].end <= run.first) ++above;
      for (std::size_t k = above; k < above_end && runs[k].first < run.end; ++k) {
        const int root = root_of(runs[k].label);
        if (run.label >= 0) parents[std::max(run.label, root)] = std::min(run.label, root);
        run.label = run.label < 0 ? root : std::min(run.label, root);
      }
      if (run.label < 0) {
        run.label = static_cast<int>(parents.size());
        parents.push_back(run.label);
      }
      runs.push_back(run);
      x = next_unlike(dark, run.end, width_, 0);
    }
    above = above_end;
    above_end = runs.size();
  }
  // Roots come before what hangs on them: number them in one pass.
  regions_.clear();
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] == static_cast<int>(i)) {
      parents[i] = static_cast<int>(regions_.size());
      regions_.push_back({width_, -1, height_, -1, 0});
    } else {
      parents[i] = parents[parents[i]];
    }
  }
  auto next = labels_.begin();
  for (const Run& run : runs) {
    const int label = parents[run.label];
    const auto first = labels_.begin() + static_cast<std::ptrdiff_t>(run.row) * width_ + run.first;
    std::fill(next, first, -1);
    next = std::fill_n(first, run.end - run.first, label);
    Region& region = regions_[label];
    region.left = std::min(region.left, run.first);
    region.right = std::max(region.right, run.end - 1);
    region.top = std::min(region.top, run.row);
    region.bottom = run.row;
    region.area += run.end - run.first;
  }
  std::fill(next, labels_.end(), -1);
}

void SquareSearch::trace_outline(int label, const Region& region, const camera::CameraModel& camera) {
  // The outermost pixels of every row and column are all of a convex outline.
  const auto add = [&](double x, double y) {
    const auto point = camera.undistort({left_ + x, top_ + y});
    if (point) outline_.push_back(*point);
  };
  const double middle = 0.5 * (shrink_ - 1);
  std::fill(first_.begin(), first_.end(), -1);
  for (int y = region.top; y <= region.bottom; ++y) {
    const int* row = &labels_[static_cast<std::size_t>(y) * width_];
    int left = -1, right = -1;
    for (int x = region.left; x <= region.right; ++x) {
      if (row[x] != label) continue;
      if (left < 0) left = x;
      right = x;
      if (first_[x] < 0) first_[x] = y;
      last_[x] = y;
    }
    if (left < 0) continue;
    add(shrink_ * left - 0.5, shrink_ * y + middle);
    add(shrink_ * right + shrink_ - 0.5, shrink_ * y + middle);
  }
  for (int x = region.left; x <= region.right; ++x) {
    if (first_[x] < 0) continue;
    add(shrink_ * x + middle, shrink_ * first_[x] - 0.5);
    add(shrink_ * x + middle, shrink_ * last_[x] + shrink_ - 0.5);
  }
}

bool SquareSearch::outline_square(int label, const Region& region, const camera::CameraModel& camera,
                                  FoundSquare& square) {
  outline_.clear();
  trace_outline(label, region, camera);
  if (outline_.size() < 16) return false;
  take_hull();
  if (hull_.size() < 4) return false;
  const double hull_area = area_of(hull_);
  while (hull_.size() > 4) {
    if (!drop_cheapest_edge(hull_)) return false;
  }
  const double quad_area = area_of(hull_);
  if (!(quad_area > 0) || hull_area < kMinFill * quad_area) return false;
  std::array<Eigen::Vector2d, 4> quad = {hull_[0], hull_[1], hull_[2], hull_[3]};
  if (!straighten_sides(quad)) return false;

  return measure_sides(camera, quad, square);
}

bool SquareSearch::measure_sides(const camera::CameraModel& camera,
                                 const std::array<Eigen::Vector2d, 4>& quad, FoundSquare& square) const {
  double shortest = 1e300, longest = 0;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d side = quad[(i + 1) % 4] - quad[i], next = quad[(i + 2) % 4] - quad[(i + 1) % 4];
    if (cross(side, next) < kMinOpening * side.norm() * next.norm()) return false;
    const auto pixel = camera.project(quad[i].homogeneous());
    if (!pixel) return false;
    // The hull turns from x to y, which is clockwise with y down.
    square.tangent[i] = quad[i];
    square.corners_px[i] = *pixel;
  }
  for (int i = 0; i < 4; ++i) {
    const double length = (square.corners_px[(i + 1) % 4] - square.corners_px[i]).norm();
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  square.longest_side_px = longest;
  return longest < kMaxSideRatio * shortest && longest >= kMinSide * shrink_;
}

// The hull is pushed out by whatever dark thing touches the square. Each side becomes the line that most of
// the outline's points near it agree on, by trying pairs of them in a fixed order.
bool SquareSearch::straighten_sides(std::array<Eigen::Vector2d, 4>& quad) const {
  double size = 0;
  for (int i = 0; i < 4; ++i) size = std::max(size, (quad[(i + 1) % 4] - quad[i]).norm());
  const double near = kNearSide * size, tight = kOnLine * size;
  std::array<Line, 4> lines;
  std::array<Eigen::Vector2d, kMaxSidePoints> points;
  std::array<double, kMaxSidePoints> xs, ys;
  for (int side = 0; side < 4; ++side) {
    const Eigen::Vector2d &a = quad[side], &b = quad[(side + 1) % 4];
    const Line guess{a, (b - a).normalized()};
    const double length = (b - a).norm();
    int count = 0;
    for (const Eigen::Vector2d& point : outline_) {
      const double along = guess.direction.dot(point - a);
      if (count < kMaxSidePoints && along > 0.05 * length && along < 0.95 * length &&
          guess.distance(point) < near) {
        xs[count] = point.x();
        ys[count] = point.y();
        points[count++] = point;
      }
    }
    if (count < 4) return false;
    Line best = guess;
    int most = 0;
    for (int trial = 0; trial < kLineTrials && most < count; ++trial) {
      const Eigen::Vector2d &p = points[trial * 7919 % count],
                            &q = points[(trial * 104729 + count / 2) % count];
      if ((q - p).norm() < 0.25 * length) continue;
      const Line line{p, (q - p).normalized()};
      if (std::abs(line.direction.dot(guess.direction)) < 0.85) continue;
      const int on = count_near(line, std::span(xs).first(count), std::span(ys).first(count), tight, most);
      if (on > most) {
        most = on;
        best = line;
      }
    }
    if (most == 0) return false;
    // Total least squares of what lies on it.
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (int i = 0; i < count; ++i) {
      if (best.distance(points[i]) < tight) mean += points[i] / most;
    }
    for (int i = 0; i < count; ++i) {
      if (best.distance(points[i]) < tight) spread += (points[i] - mean) * (points[i] - mean).transpose();
    }
    const double angle = 0.5 * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1));
    lines[side] = {mean, {std::cos(angle), std::sin(angle)}};
  }
  for (int corner = 0; corner < 4; ++corner) {
    const Line &before = lines[(corner + 3) % 4], &after = lines[corner];
    const double turn = cross(before.direction, after.direction);
    if (std::abs(turn) < kMinOpening) return false;
    quad[corner] =
        before.point + before.direction * (cross(after.point - before.point, after.direction) / turn);
  }
  return area_of(quad) > 0;
}

// Andrew's monotone chain, turning from x to y.
void SquareSearch::take_hull() {
  std::sort(outline_.begin(), outline_.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  hull_.clear();
  const auto add = [this](const Eigen::Vector2d& point, std::size_t keep) {
    while (hull_.size() > keep && cross(hull_.back() - hull_[hull_.size() - 2], point - hull_.back()) <= 0)
      hull_.pop_back();
    hull_.push_back(point);
  };
  for (const Eigen::Vector2d& point : outline_) add(point, 1);
  const std::size_t lower = hull_.size();
  for (auto point = outline_.rbegin() + 1; point != outline_.rend(); ++point) add(*point, lower);
  hull_.pop_back();
}

}  // namespace arthronaut::markers
