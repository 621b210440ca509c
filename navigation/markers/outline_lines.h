// Lines and corners of the outlines that the square search looks at. Inner header of the square search.
#pragma once

#include <Eigen/Core>
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

}  // namespace arthronaut::markers
