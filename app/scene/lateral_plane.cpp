#include "app/scene/lateral_plane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "planning/landmarks/grid_landmarks.h"

namespace arthronaut::scene {

using bones::BoneKind;

std::vector<Eigen::Vector3d> joint_end(const geometry::TriangleMesh& mesh, BoneKind kind,
                                       const landmarks::AnatomicalAxes& axes, double shown_mm) {
  const Eigen::Vector3d into_bone = kind == BoneKind::Femur ? axes.proximal : Eigen::Vector3d(-axes.proximal);
  double joint = std::numeric_limits<double>::infinity();
  for (const auto& vertex : mesh.vertices_mm) joint = std::min(joint, vertex.dot(into_bone));
  std::vector<Eigen::Vector3d> part;
  for (const auto& vertex : mesh.vertices_mm)
    if (vertex.dot(into_bone) <= joint + shown_mm) part.push_back(vertex);
  return part;
}

geometry::Bounds joint_bounds(const geometry::TriangleMesh& mesh, BoneKind kind,
                              const landmarks::AnatomicalAxes& axes) {
  constexpr double kShown_mm = 80;
  geometry::TriangleMesh part;
  part.vertices_mm = joint_end(mesh, kind, axes, kShown_mm);
  return geometry::bounds_of(part);
}

geometry::Bounds with_grid(geometry::Bounds shown, const landmarks::FemoralQuadrant& quadrant) {
  for (const double along : {0.0, 100.0}) {
    for (const double across : {0.0, 100.0}) {
      const Eigen::Vector3d corner = quadrant.point_at({along, across});
      shown.min_mm = shown.min_mm.cwiseMin(corner);
      shown.max_mm = shown.max_mm.cwiseMax(corner);
    }
  }
  return shown;
}

SlicePlane lateral_plane(const landmarks::AnatomicalAxes& axes,
                         const std::optional<landmarks::FemoralQuadrant>& quadrant,
                         const geometry::Bounds& shown, const Eigen::Vector2i& size_px) {
  Eigen::Vector3d medially = -axes.lateral;  // the way the beam goes
  if (quadrant) {
    medially = quadrant->shallow.cross(quadrant->low).normalized();
    if (medially.dot(axes.lateral) > 0) medially = -medially;
  }
  SlicePlane plane;
  plane.down = (-axes.proximal + axes.proximal.dot(medially) * medially).normalized();
  plane.right = plane.down.cross(medially);
  const geometry::Bounds all = quadrant ? with_grid(shown, *quadrant) : shown;
  plane.center_mm = all.center_mm();
  const Eigen::Vector3d half = 0.5 * all.size_mm();
  constexpr double kMargin = 1.08;
  plane.mm_per_px = kMargin * std::max(2 * half.dot(plane.right.cwiseAbs()) / std::max(size_px.x(), 1),
                                       2 * half.dot(plane.down.cwiseAbs()) / std::max(size_px.y(), 1));
  return plane;
}

std::string lateral_plane_in_words(const landmarks::AnatomicalAxes& axes,
                                   const std::optional<landmarks::FemoralQuadrant>& quadrant,
                                   const landmarks::Landmarks& femur) {
  if (!quadrant)
    return "Lateral view by " + std::string(to_text(axes.origin)) +
           ". No grid: Blumensaat's line is not marked";
  // Without the condyles the grid is laid along the scanner's axis.
  const bool follows_condyles =
      std::ranges::all_of(landmarks::grid_landmarks(BoneKind::Femur, femur),
                          [&](const std::string& name) { return femur.contains(name); });
  return follows_condyles ? "True lateral view, condyles superposed"
                          : "Lateral view along the scanner's axis: the condyles are not marked";
}

}  // namespace arthronaut::scene
