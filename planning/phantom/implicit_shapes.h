// Building blocks of implicit surfaces: negative inside, positive outside, about 1 per mm near the surface.
// Inner header of the phantom.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace arthronaut::phantom {

// Union whose crease is filled over about k mm.
[[nodiscard]] inline double smooth_union(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - 0.25 * h * h * k;
}

// Intersection whose edge is a circular fillet of the given radius where the two meet at a right angle.
[[nodiscard]] inline double filleted_intersection(double a, double b, double radius_mm) {
  const double u = std::max(radius_mm + a, 0.0), v = std::max(radius_mm + b, 0.0);
  // A root is needed at the fillet alone.
  const double from_middle = u == 0 ? v : v == 0 ? u : std::hypot(u, v);
  return std::min(-radius_mm, std::max(a, b)) + from_middle;
}

[[nodiscard]] inline double filleted_difference(double a, double b, double radius_mm) {
  return filleted_intersection(a, -b, radius_mm);
}

// 0 below low, 1 above high, smooth in between.
[[nodiscard]] inline double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

struct Circle {
  Eigen::Vector2d center_mm;
  double radius_mm;
};

// Distance to the convex hull of two circles, neither of which holds the other.
[[nodiscard]] inline double hull_of_circles(const Eigen::Vector2d& p, const Circle& a, const Circle& b) {
  const Eigen::Vector2d axis = b.center_mm - a.center_mm;
  const double length = axis.norm();
  const Eigen::Vector2d along = axis / length, from_a = p - a.center_mm;
  const double y = from_a.dot(along), x = std::abs(from_a.x() * along.y() - from_a.y() * along.x());
  const double sine = (a.radius_mm - b.radius_mm) / length, cosine = std::sqrt(1.0 - sine * sine);
  const double k = cosine * y - sine * x;
  if (k < 0.0) return std::hypot(x, y) - a.radius_mm;
  if (k > cosine * length) return std::hypot(x, y - length) - b.radius_mm;
  return cosine * x + sine * y - a.radius_mm;
}

// First-order distance to an ellipsoid.
[[nodiscard]] inline double ellipsoid(const Eigen::Vector3d& p, const Eigen::Vector3d& center_mm,
                                      const Eigen::Vector3d& radii_mm) {
  const Eigen::Vector3d q = p - center_mm;
  const double k0 = q.cwiseQuotient(radii_mm).norm();
  const double k1 = q.cwiseQuotient(radii_mm.cwiseAbs2()).norm();
  return k1 < 1e-9 ? -radii_mm.minCoeff() : k0 * (k0 - 1.0) / k1;
}

// First-order distance to the superellipse |x/a|^n + |y/b|^n = 1.
[[nodiscard]] inline double superellipse(double x, double y, double a, double b, double n) {
  const double u = std::abs(x / a), v = std::abs(y / b);
  const bool is_ellipse = n == 2.0;
  const double un = is_ellipse ? u : std::pow(u, n - 1.0), vn = is_ellipse ? v : std::pow(v, n - 1.0);
  const double rho_n = un * u + vn * v;
  if (rho_n < 1e-6) return -std::min(a, b);
  const double rho = std::pow(rho_n, 1.0 / n);
  // |grad rho| = |(un / a, vn / b)| / rho^(n-1)
  return (rho - 1.0) * (is_ellipse ? rho : std::pow(rho, n - 1.0)) / std::hypot(un / a, vn / b);
}

}  // namespace arthronaut::phantom
