#include "planning/geometry/triangle_mesh.h"

#include <Eigen/Geometry>

namespace arthronaut::geometry {

Bounds bounds_of(const TriangleMesh& mesh) {
  Bounds bounds{mesh.vertices_mm.front(), mesh.vertices_mm.front()};
  for (const auto& v : mesh.vertices_mm) {
    bounds.min_mm = bounds.min_mm.cwiseMin(v);
    bounds.max_mm = bounds.max_mm.cwiseMax(v);
  }
  return bounds;
}

std::vector<Eigen::Vector3d> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.vertices_mm.size(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices_mm[t[0]];
    const Eigen::Vector3d doubled_area = (mesh.vertices_mm[t[1]] - a).cross(mesh.vertices_mm[t[2]] - a);
    for (const auto v : t) normals[v] += doubled_area;
  }
  for (auto& n : normals) {
    const double length = n.norm();
    if (length > 0) n /= length;
  }
  return normals;
}

double signed_volume_mm3(const TriangleMesh& mesh) {
  double six_volumes = 0;
  for (const auto& t : mesh.triangles) {
    six_volumes += mesh.vertices_mm[t[0]].dot(mesh.vertices_mm[t[1]].cross(mesh.vertices_mm[t[2]]));
  }
  return six_volumes / 6;
}

double surface_area_mm2(const TriangleMesh& mesh) {
  double doubled = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices_mm[t[0]];
    doubled += (mesh.vertices_mm[t[1]] - a).cross(mesh.vertices_mm[t[2]] - a).norm();
  }
  return doubled / 2;
}

}  // namespace arthronaut::geometry
