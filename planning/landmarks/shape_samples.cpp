#include "planning/landmarks/shape_samples.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace arthronaut::landmarks {

namespace {

using Eigen::Vector3d;

// Van der Corput: spreads the samples of a large triangle over it.
double radical_inverse(std::size_t n, std::size_t base) {
  double value = 0, share = 1.0 / static_cast<double>(base);
  for (; n > 0; n /= base, share /= static_cast<double>(base)) value += share * static_cast<double>(n % base);
  return value;
}

}  // namespace

std::vector<SurfaceSample> sample_surface(const geometry::TriangleMesh& mesh, double each_mm2) {
  constexpr double kMost = 1e6;  // of a bone in a wrong unit
  const auto corner = [&](const std::array<std::int32_t, 3>& t, std::size_t k) -> const Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(t[k])];
  };
  const double total = geometry::surface_area_mm2(mesh);
  std::vector<SurfaceSample> samples;
  if (!(total > 0)) return samples;
  const double each = std::max(each_mm2, total / kMost);
  samples.reserve(static_cast<std::size_t>(total / each) + 1);
  double before = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = corner(t, 1) - corner(t, 0), b = corner(t, 2) - corner(t, 0);
    const Vector3d across = a.cross(b);
    const double area = 0.5 * across.norm();
    if (!(area > 0)) continue;
    const Vector3d normal = across.normalized();
    while ((static_cast<double>(samples.size()) + 0.5) * each < before + area) {
      const double root = std::sqrt(radical_inverse(samples.size() + 1, 2));
      const double v = radical_inverse(samples.size() + 1, 3);
      samples.push_back({corner(t, 0) + root * (1 - v) * a + root * v * b, normal});
    }
    before += area;
  }
  return samples;
}

std::optional<Vector3d> furthest(const std::vector<Vector3d>& points_mm, const Vector3d& direction,
                                 double each_mm2, double cap_mm) {
  const auto furthest_count = static_cast<std::size_t>(std::ceil(kReach_mm2 / each_mm2));
  if (points_mm.size() < furthest_count) return std::nullopt;
  std::vector<double> heights;
  heights.reserve(points_mm.size());
  for (const Vector3d& p : points_mm) heights.push_back(p.dot(direction));
  // A heap with the least of the furthest on top: hardly any other gets past it.
  std::vector<double> top(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(furthest_count));
  std::ranges::make_heap(top, std::greater<>());
  for (std::size_t i = furthest_count; i < heights.size(); ++i) {
    if (!(heights[i] > top.front())) continue;
    std::ranges::pop_heap(top, std::greater<>());
    top.back() = heights[i];
    std::ranges::push_heap(top, std::greater<>());
  }
  const double reach = std::accumulate(top.begin(), top.end(), 0.0) / static_cast<double>(furthest_count);
  Vector3d sum = Vector3d::Zero();
  double weights = 0;
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    if (reach - heights[i] >= cap_mm) continue;  // most: spared the division
    const double weight = 1 - (reach - heights[i]) / cap_mm;
    sum += weight * points_mm[i];
    weights += weight;
  }
  const Vector3d middle = sum / weights;
  return Vector3d(middle + (reach - middle.dot(direction)) * direction);
}

std::vector<Section> sections_across(const geometry::TriangleMesh& mesh, const Vector3d& axis,
                                     double first_mm, double step_mm, std::size_t count) {
  const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  std::vector<Section> sections(count);
  std::vector<Eigen::Vector2d> moment(count, Eigen::Vector2d::Zero());
  for (const auto& t : mesh.triangles) {
    std::array<Vector3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.vertices_mm[static_cast<std::size_t>(t[k])];
    const std::array<double, 3> h{p[0].dot(axis), p[1].dot(axis), p[2].dot(axis)};
    const auto [low, high] = std::minmax_element(h.begin(), h.end());
    const double from = std::ceil((*low - first_mm) / step_mm), to = std::floor((*high - first_mm) / step_mm);
    const Vector3d along = axis.cross((p[1] - p[0]).cross(p[2] - p[0]));  // the bone lies to its left
    for (double i = std::max(0.0, from); i <= to && i < static_cast<double>(count); ++i) {
      const double height = first_mm + i * step_mm;
      std::array<Eigen::Vector2d, 2> ends;
      std::size_t found = 0;
      for (std::size_t k = 0; k < 3 && found < 2; ++k) {
        const std::size_t n = (k + 1) % 3;
        if ((h[k] < height) == (h[n] < height)) continue;
        const Vector3d q = p[k] + (height - h[k]) / (h[n] - h[k]) * (p[n] - p[k]);
        ends[found++] = {q.dot(u), q.dot(v)};
      }
      if (found < 2) continue;
      if ((ends[1] - ends[0]).dot(Eigen::Vector2d(along.dot(u), along.dot(v))) < 0)
        std::swap(ends[0], ends[1]);
      const double cross = ends[0].x() * ends[1].y() - ends[0].y() * ends[1].x();
      const auto index = static_cast<std::size_t>(i);
      sections[index].area_mm2 += cross / 2;
      moment[index] += cross / 6 * (ends[0] + ends[1]);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!(sections[i].area_mm2 > 0)) continue;
    const Eigen::Vector2d center = moment[i] / sections[i].area_mm2;
    sections[i].center_mm =
        center.x() * u + center.y() * v + (first_mm + static_cast<double>(i) * step_mm) * axis;
  }
  return sections;
}

FittedLine fit_line(const std::vector<Vector3d>& points_mm) {
  FittedLine line;
  if (points_mm.empty()) return line;
  for (const Vector3d& p : points_mm) line.point_mm += p / static_cast<double>(points_mm.size());
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points_mm) moment += (p - line.point_mm) * (p - line.point_mm).transpose();
  line.direction = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moment).eigenvectors().col(2);
  return line;
}

}  // namespace arthronaut::landmarks
