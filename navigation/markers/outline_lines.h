// Lines and corners of the outlines that the square search looks at. Inner header of the square search.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace arthronaut::markers {

inline constexpr double kMinOpening = 0.25;  // sine of a corner's angle
inline constexpr std::size_t kMaxSquares = 64;

inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

inline double area_of(std::span<const Eigen::Vector2d> polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

struct Line {
  Eigen::Vector2d point = Eigen::Vector2d::Zero(), direction = Eigen::Vector2d::UnitX();
  [[nodiscard]] double distance(const Eigen::Vector2d& p) const {
    return std::abs(cross(direction, p - point));
  }
};

// How many of these points lie nearer to the line than this; where they cannot be more than `most`, it may
// stop counting.
inline int count_near(const Line& line, std::span<const double> xs, std::span<const double> ys, double near,
                      int most) {
  constexpr std::size_t kAtATime = 32;
  const double dx = line.direction.x(), dy = line.direction.y(), px = line.point.x(), py = line.point.y();
  int count = 0;
  for (std::size_t first = 0; first < xs.size(); first += kAtATime) {
    const std::size_t end = std::min(xs.size(), first + kAtATime);
    if (count + static_cast<int>(xs.size() - first) <= most) return count;
    for (std::size_t i = first; i < end; ++i) count += std::abs(dx * (ys[i] - py) - dy * (xs[i] - px)) < near;
  }
  return count;
}

}  // namespace arthronaut::markers
