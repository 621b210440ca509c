#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "navigation/lens/rim.h"

namespace arthronaut::lens {
namespace {

// Grey level of the mask: a low quantile of the picture, which the mask's corners fill even when the circle
// is large.
int mask_level(const camera::GrayView& picture) {
  std::array<int, 256> histogram{};
  int count = 0;
  for (int y = 2; y < picture.height; y += 8)
    for (int x = 2; x < picture.width; x += 8, ++count) ++histogram[picture.row(y)[x]];
  int sum = 0, value = 0;
  while (value < 255 && (sum += histogram[static_cast<std::size_t>(value)]) < 0.05 * count) ++value;
  return value;
}

constexpr int kMargin = 4;  // the outermost pixels of a picture often are a frame of their own

// First position of three lit samples in a row along a line of the picture, or -1.
int first_light(const std::uint8_t* start, std::ptrdiff_t step, int count, int lit) {
  int run = 0;
  for (int k = kMargin; k < count; ++k) {
    if (start[k * step] <= lit) {
      run = 0;
    } else if (++run == 3) {
      const int at = k - 2;
      return at > kMargin + 1 ? at : -1;  // lit from the start: the mask is out of the picture here
    }
  }
  return -1;
}

void find_first_lights(const camera::GrayView& picture, int lit, std::vector<Eigen::Vector2d>& points) {
  points.clear();
  const int w = picture.width, h = picture.height;
  const int row_step = std::max(2, h / 90), column_step = std::max(2, w / 120);
  // A rim on this side of a circle that is plausible; in a dark scene the rest of the line would cost the
  // most.
  const int reach = w * 6 / 10;
  for (int y = row_step / 2; y < h; y += row_step) {
    const int left = first_light(picture.row(y), 1, reach, lit);
    const int right = first_light(picture.row(y) + w - 1, -1, reach, lit);
    if (left >= 0) points.emplace_back(left, y);
    if (right >= 0) points.emplace_back(w - 1 - right, y);
  }
  for (int x = column_step / 2; x < w; x += column_step) {
    const int top = first_light(picture.data + x, picture.stride, h, lit);
    const int bottom = first_light(picture.row(h - 1) + x, -picture.stride, h, lit);
    if (top >= 0) points.emplace_back(x, top);
    if (bottom >= 0) points.emplace_back(x, h - 1 - bottom);
  }
}

std::optional<camera::Boundary> circle_through(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                               const Eigen::Vector2d& c) {
  const Eigen::Vector2d ab = b - a, ac = c - a;
  const double d = 2 * (ab.x() * ac.y() - ab.y() * ac.x());
  if (std::abs(d) < 1e-6) return std::nullopt;
  const Eigen::Vector2d offset(ac.y() * ab.squaredNorm() - ab.y() * ac.squaredNorm(),
                               ab.x() * ac.squaredNorm() - ac.x() * ab.squaredNorm());
  camera::Boundary circle;
  circle.center_px = a + offset / d;
  circle.radius_px = (offset / d).norm();
  return circle;
}

}  // namespace

std::optional<camera::Boundary> search_circle(const camera::GrayView& picture, SearchScratch& scratch) {
  if (picture.width < 64 || picture.height < 64) return std::nullopt;
  find_first_lights(picture, mask_level(picture) + 14, scratch.points);
  const std::vector<Eigen::Vector2d>& points = scratch.points;
  const int n = static_cast<int>(points.size());
  if (n < 24) return std::nullopt;

  const double size = std::min(picture.width, picture.height);
  const double tolerance_px = std::max(2.0, 0.004 * size);
  const auto is_plausible = [&](const camera::Boundary& circle) {
    return circle.radius_px > 0.2 * size &&
           circle.radius_px < 0.75 * std::max(picture.width, picture.height) &&
           circle.center_px.x() > 0.2 * picture.width && circle.center_px.x() < 0.8 * picture.width &&
           circle.center_px.y() > 0.2 * picture.height && circle.center_px.y() < 0.8 * picture.height;
  };
  const auto support = [&](const camera::Boundary& circle) {
    // Squares of the distances: this is most of the search's time.
    const double low = circle.radius_px - tolerance_px, high = circle.radius_px + tolerance_px;
    int count = 0;
    for (const Eigen::Vector2d& p : points) {
      const double square = (p - circle.center_px).squaredNorm();
      count += square > low * low && square < high * high;
    }
    return count;
  };
  // So many trials that three points of the best circle's share meet once, but for one case in a million.
  const auto trials_needed = [n](int supporters) {
    const double share = static_cast<double>(supporters) / n;
    return std::log(1e-6) / std::log(1 - std::min(0.999, share * share * share));
  };

  std::mt19937 random(20);
  std::uniform_int_distribution<int> any(0, n - 1);
  camera::Boundary best;
  int best_support = 0;
  for (int trial = 0; trial < 400 && (best_support == 0 || trial < trials_needed(best_support)); ++trial) {
    const auto circle = circle_through(points[static_cast<std::size_t>(any(random))],
                                       points[static_cast<std::size_t>(any(random))],
                                       points[static_cast<std::size_t>(any(random))]);
    if (!circle || !is_plausible(*circle)) continue;
    if (const int count = support(*circle); count > best_support) {
      best_support = count;
      best = *circle;
    }
  }
  // A scene without a mask has chance circles; a real rim explains most of the first lights.
  if (best_support < 20 || best_support < 0.35 * n) return std::nullopt;

  for (int pass = 0; pass < 3; ++pass) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector2d d = p - best.center_px;
      const double e = d.norm() - best.radius_px;
      if (std::abs(e) > tolerance_px) continue;
      const Eigen::Vector3d row(d.x() / d.norm(), d.y() / d.norm(), 1);
      normal += row * row.transpose();
      right += e * row;
    }
    const Eigen::Vector3d step = normal.ldlt().solve(right);
    if (!step.allFinite()) break;
    best.center_px += step.head<2>();
    best.radius_px += step.z();
  }
  if (!is_plausible(best)) return std::nullopt;
  return best;
}

}  // namespace arthronaut::lens
