#include "app/scene/radiograph.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace arthronaut::scene {

std::vector<float> thickness_along(const geometry::TriangleMesh& mesh, const SlicePlane& plane,
                                   const Eigen::Vector2i& size_px) {
  // A pixel's beam never goes through an edge of the mesh: its place is off the grid by a hair that no
  // coordinate has.
  constexpr double kHair_px = 1.2345e-7;
  const auto width = static_cast<std::size_t>(std::max(size_px.x(), 0));
  std::vector<float> thickness(width * static_cast<std::size_t>(std::max(size_px.y(), 0)), 0);
  const Eigen::Vector3d along = plane.normal();
  std::vector<Eigen::Vector3d> seen(mesh.vertices_mm.size());  // pixel x, pixel y, depth
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector2d pixel = plane.pixel_of(mesh.vertices_mm[i], size_px);
    seen[i] = {pixel.x() + kHair_px, pixel.y() + 1.7 * kHair_px,
               along.dot(mesh.vertices_mm[i] - plane.center_mm)};
  }
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d &a = seen[static_cast<std::size_t>(triangle[0])],
                          &b = seen[static_cast<std::size_t>(triangle[1])],
                          &c = seen[static_cast<std::size_t>(triangle[2])];
    // Positive: seen from behind, where the beam leaves the bone. (y runs down, the beam away from the eye.)
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (area == 0) continue;
    const int top = std::max(static_cast<int>(std::ceil(std::min({a.y(), b.y(), c.y()}))), 0);
    const int bottom =
        std::min(static_cast<int>(std::floor(std::max({a.y(), b.y(), c.y()}))), size_px.y() - 1);
    for (int y = top; y <= bottom; ++y) {
      double from = 1e30, to = -1e30;  // where the row crosses the triangle's edges
      for (const auto& [p, q] : {std::pair{&a, &b}, std::pair{&b, &c}, std::pair{&c, &a}}) {
        if ((p->y() <= y) == (q->y() <= y)) continue;
        const double x = p->x() + (y - p->y()) / (q->y() - p->y()) * (q->x() - p->x());
        from = std::min(from, x);
        to = std::max(to, x);
      }
      const int first = std::max(static_cast<int>(std::ceil(from)), 0);
      const int last = std::min(static_cast<int>(std::ceil(to)) - 1, size_px.x() - 1);
      for (int x = first; x <= last; ++x) {
        const double v = ((b.x() - x) * (c.y() - y) - (c.x() - x) * (b.y() - y)) / area;  // share of a
        const double w = ((c.x() - x) * (a.y() - y) - (a.x() - x) * (c.y() - y)) / area;  // of b
        const double depth = v * a.z() + w * b.z() + (1 - v - w) * c.z();
        thickness[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] +=
            static_cast<float>(area > 0 ? depth : -depth);
      }
    }
  }
  for (float& value : thickness) value = std::max(value, 0.F);
  return thickness;
}

std::vector<std::uint8_t> radiograph_from(const std::vector<float>& thickness_mm, double attenuation_per_mm) {
  std::vector<std::uint8_t> grey(thickness_mm.size());
  std::transform(thickness_mm.begin(), thickness_mm.end(), grey.begin(), [&](float thickness) {
    return static_cast<std::uint8_t>(std::lround(255 * (1 - std::exp(-attenuation_per_mm * thickness))));
  });
  return grey;
}

}  // namespace arthronaut::scene
