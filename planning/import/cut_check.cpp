#include "planning/import/cut_check.h"

#include <Eigen/Geometry>
#include <cmath>

namespace arthronaut::importing {

namespace {

using Eigen::Vector3d;

// Of a bone that only touches the edge of the images a few voxels of its rim do.
constexpr double kLeastCut_mm2 = 10;
// The flat cap lies half a voxel beyond the last one's centre, its rounded rim a little inside.
constexpr double kOfTheEdge_voxels = 0.75;
// Between the cap's normal and the way out of the images; a bone's own face turns away from it soon.
constexpr double kFlat_cos = 0.97;
// Within 45 degrees of the way that the shaft goes.
constexpr double kAlongShaft_cos = 0.7071;

// Of the mesh in the edge of the images that `axis` of the volume ends in; `at_mm` in its middle.
bones::ImageCut cut_in(const geometry::TriangleMesh& mesh, const std::vector<Vector3d>& in_voxels,
                       double edge_voxel, Eigen::Index axis, const Vector3d& out) {
  bones::ImageCut cut{.out = out};
  Vector3d weighted_mm = Vector3d::Zero();
  for (const auto& t : mesh.triangles) {
    bool is_in_edge = true;
    for (const auto corner : t)
      is_in_edge = is_in_edge && std::abs(in_voxels[static_cast<std::size_t>(corner)][axis] - edge_voxel) <
                                     kOfTheEdge_voxels;
    if (!is_in_edge) continue;
    const auto point = [&](std::size_t k) -> const Vector3d& {
      return mesh.vertices_mm[static_cast<std::size_t>(t[k])];
    };
    const Vector3d twice = (point(1) - point(0)).cross(point(2) - point(0));
    if (twice.dot(out) <= kFlat_cos * twice.norm()) continue;
    cut.area_mm2 += twice.norm() / 2;
    weighted_mm += twice.norm() / 6 * (point(0) + point(1) + point(2));
  }
  if (cut.area_mm2 > 0) cut.at_mm = weighted_mm / cut.area_mm2;
  return cut;
}

}  // namespace

std::vector<bones::ImageCut> cuts_of(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                                     const images::Volume& volume) {
  const Eigen::Affine3d voxel_from_lps = volume.lps_from_index.inverse();
  std::vector<Vector3d> in_voxels;
  in_voxels.reserve(mesh.vertices_mm.size());
  for (const Vector3d& at : mesh.vertices_mm) in_voxels.push_back(voxel_from_lps * at);
  const Vector3d shaft = kind == bones::BoneKind::Femur ? Vector3d::UnitZ() : Vector3d(-Vector3d::UnitZ());
  std::vector<bones::ImageCut> cuts;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const bool is_last : {false, true}) {
      // At right angles to the face, whatever the axes' own angles.
      const Vector3d voxels_a_mm = (is_last ? 1 : -1) * voxel_from_lps.linear().row(axis).transpose();
      const Vector3d out = voxels_a_mm.normalized();
      if (out.dot(shaft) > kAlongShaft_cos) continue;
      const double edge_voxel = is_last ? volume.size[axis] - 0.5 : -0.5;
      bones::ImageCut cut = cut_in(mesh, in_voxels, edge_voxel, axis, out);
      if (cut.area_mm2 < kLeastCut_mm2) continue;
      // As far in as the edge was taken to reach.
      const double from_edge_voxels = (is_last ? 1 : -1) * ((voxel_from_lps * cut.at_mm)[axis] - edge_voxel);
      cut.at_mm -= (from_edge_voxels + kOfTheEdge_voxels) / voxels_a_mm.norm() * out;
      cuts.push_back(cut);
    }
  }
  return cuts;
}

}  // namespace arthronaut::importing
