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

// `count` samples, each for the same area, so that coarse and fine meshes of a bone weigh alike. They depend
// on the order of the triangles, not on how the bone lies. Empty for a mesh without area.
[[nodiscard]] std::vector<SurfaceSample> sample_surface(const geometry::TriangleMesh& mesh,
                                                        std::size_t count);

// Where samples reach furthest along the unit `direction`: as far as the mean of the `kReach` furthest, and
// across it in the middle of what lies within cap_mm of there, the nearer to it the more. A single sample
// wanders over a flat side; this does not. nullopt for fewer than kReach.
inline constexpr std::size_t kReach = 12;
[[nodiscard]] std::optional<Eigen::Vector3d> furthest(const std::vector<Eigen::Vector3d>& points_mm,
                                                      const Eigen::Vector3d& direction, double cap_mm = 1.0);

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
