// The bone as points spread evenly over its surface, and as plane sections. Inner header of landmarks.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::landmarks {

struct SurfaceSample {
  Eigen::Vector3d point_mm, normal;
};

// One for each `each_mm2`, so that coarse and fine meshes of a bone weigh alike, and a bone of which less is
// there is seen as closely. They depend on the order of the triangles, not on how the bone lies. Empty for a
// mesh without area; of one that is larger than any bone a million.
[[nodiscard]] std::vector<SurfaceSample> sample_surface(const geometry::TriangleMesh& mesh, double each_mm2);

// Close enough for a search, and for where a landmark lies: of 1 mm2 each, the middle of a cap wanders by
// up to 1 mm with which points of it are taken, of a quarter of that it keeps to 0.1 mm.
inline constexpr double kCoarse_mm2 = 1, kFine_mm2 = 0.25;

// Where samples reach furthest along the unit `direction`: as far as the mean of the furthest kReach_mm2 of
// them, and across it in the middle of what lies within cap_mm of there, the nearer to it the more. A single
// sample wanders over a flat side; this does not. each_mm2: what a sample stands for. nullopt for fewer than
// kReach_mm2.
inline constexpr double kReach_mm2 = 12;
[[nodiscard]] std::optional<Eigen::Vector3d> furthest(const std::vector<Eigen::Vector3d>& points_mm,
                                                      const Eigen::Vector3d& direction, double each_mm2,
                                                      double cap_mm = 1.0);

// What a plane at right angles to the unit `axis` cuts out of a closed mesh.
struct Section {
  double area_mm2 = 0;
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  // of the area; meaningful where it is more than 0
};
// At each of `heights_mm` along the axis, ascending and evenly spaced; by Green's theorem over the cut
// triangles, so that nothing has to be stitched.
[[nodiscard]] std::vector<Section> sections_across(const geometry::TriangleMesh& mesh,
                                                   const Eigen::Vector3d& axis, double first_mm,
                                                   double step_mm, std::size_t count);

// The straight line through points, by least squares: a point of it and its unit direction.
struct FittedLine {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::UnitZ();
};
[[nodiscard]] FittedLine fit_line(const std::vector<Eigen::Vector3d>& points_mm);

}  // namespace arthronaut::landmarks
