#include "planning/postop/surface_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

namespace arthronaut::postop {

std::vector<SurfaceSample> surface_samples(const geometry::TriangleMesh& mesh, const Eigen::Vector3d& near_mm,
                                           double radius_mm, std::size_t count) {
  const auto normals = geometry::vertex_normals(mesh);
  const auto corner = [&](std::size_t t, std::size_t c) {
    return static_cast<std::size_t>(mesh.triangles[t][c]);
  };
  std::vector<std::size_t> triangles;
  std::vector<double> area_until;
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d &a = mesh.vertices_mm[corner(t, 0)], &b = mesh.vertices_mm[corner(t, 1)],
                          &c = mesh.vertices_mm[corner(t, 2)];
    if (((a + b + c) / 3 - near_mm).norm() > radius_mm) continue;
    area += 0.5 * (b - a).cross(c - a).norm();
    triangles.push_back(t);
    area_until.push_back(area);
  }
  std::vector<SurfaceSample> samples;
  if (!(area > 0)) return samples;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = std::lower_bound(area_until.begin(), area_until.end(), area * share(random));
    const std::size_t t = triangles[static_cast<std::size_t>(
        std::min<std::ptrdiff_t>(at - area_until.begin(), std::ssize(triangles) - 1))];
    // Even over the triangle.
    const double root = std::sqrt(share(random)), v = share(random);
    const Eigen::Vector3d weights(1 - root, root * (1 - v), root * v);
    SurfaceSample sample{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (std::size_t c = 0; c < 3; ++c) {
      sample.point_mm += weights[static_cast<Eigen::Index>(c)] * mesh.vertices_mm[corner(t, c)];
      sample.normal += weights[static_cast<Eigen::Index>(c)] * normals[corner(t, c)];
    }
    if (!(sample.normal.norm() > 1e-6)) continue;
    sample.normal.normalize();
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace arthronaut::postop
