#include "planning/import/cut_check.h"

#include <Eigen/Geometry>
#include <cmath>

#include "planning/files/format.h"

namespace arthronaut::importing {

namespace {

using Eigen::Vector3d;

constexpr double kLeastCut_mm2 = 100;
// The flat cap lies half a voxel beyond the last one's centre, its rounded rim a little inside.
constexpr double kOfTheEdge_voxels = 0.75;
// Between the cap's normal and the way out of the images; a bone's own face turns away from it soon.
constexpr double kFlat_cos = 0.97;
// Within 45 degrees of the way that the shaft goes.
constexpr double kAlongShaft_cos = 0.7071;

const char* side_in_words(const Vector3d& out) {
  Eigen::Index axis = 0;
  out.cwiseAbs().maxCoeff(&axis);
  const bool is_towards_more = out[axis] > 0;
  if (axis == 0) return is_towards_more ? "on the patient's left" : "on the patient's right";
  if (axis == 1) return is_towards_more ? "behind" : "in front";
  return is_towards_more ? "above" : "below";
}

// Of the mesh in the edge of the images that `axis` of the volume ends in.
double cut_mm2(const geometry::TriangleMesh& mesh, const std::vector<Vector3d>& in_voxels, double edge_voxel,
               Eigen::Index axis, const Vector3d& out) {
  double area = 0;
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
    if (twice.dot(out) > kFlat_cos * twice.norm()) area += twice.norm() / 2;
  }
  return area;
}

}  // namespace

std::string cut_doubt(const ImageCut& cut) {
  return files::format(
      "the images end within it: %.0f cm\u00B2 of it are cut off flat %s, and what lies beyond is missing",
      cut.area_mm2 / 100, side_in_words(cut.out));
}

std::vector<ImageCut> cuts_of(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                              const images::Volume& volume) {
  const Eigen::Affine3d voxel_from_lps = volume.lps_from_index.inverse();
  std::vector<Vector3d> in_voxels;
  in_voxels.reserve(mesh.vertices_mm.size());
  for (const Vector3d& at : mesh.vertices_mm) in_voxels.push_back(voxel_from_lps * at);
  const Vector3d shaft = kind == bones::BoneKind::Femur ? Vector3d::UnitZ() : Vector3d(-Vector3d::UnitZ());
  std::vector<ImageCut> cuts;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const bool is_last : {false, true}) {
      // At right angles to the face, whatever the axes' own angles.
      const Vector3d out = (is_last ? 1 : -1) * voxel_from_lps.linear().row(axis).transpose().normalized();
      if (out.dot(shaft) > kAlongShaft_cos) continue;
      const double edge_voxel = is_last ? volume.size[axis] - 0.5 : -0.5;
      const double area_mm2 = cut_mm2(mesh, in_voxels, edge_voxel, axis, out);
      if (area_mm2 >= kLeastCut_mm2) cuts.push_back({out, area_mm2});
    }
  }
  return cuts;
}

}  // namespace arthronaut::importing
