// A bone's pose by the edges that a CT shows where the bone's surface should be. Inner header of postop.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/images/volume_sampler.h"
#include "planning/postop/surface_samples.h"

namespace arthronaut::postop {

struct EdgePose {
  geometry::RigidTransform postop_from_plan;
  double rms_mm = std::numeric_limits<double>::infinity();  // of the nearest nine in ten of the edges seen
  double bias_mm = 0;  // mean of the same: the images' surface lies outside (+) or inside (-) of the plan's
  double spread_mm = std::numeric_limits<double>::infinity();  // rms about the bias
  // How much longer or shorter, in the direction where it is most, the bone would have to be to fit best: the
  // same bone of the same patient is as long as it was.
  double stretch = std::numeric_limits<double>::infinity();
  double on_edge_share = 0;  // of the samples in view: an edge within 1 mm
  double in_view_share = 0;  // of all samples
  // Covariance of the pose about `center_mm` (LPS of the images): shift in mm, then turn in rad.
  geometry::Matrix6d covariance = geometry::Matrix6d::Identity();
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();

  // One sigma of a point of the plan, by the scatter of the edges.
  [[nodiscard]] double sigma_at_mm(const Eigen::Vector3d& p_in_plan) const;
  // The same of a unit direction of the plan, rad.
  [[nodiscard]] double sigma_of_direction_rad(const Eigen::Vector3d& in_plan) const;
};

// From a pose that is right to some 6 mm. Edges are where the grey falls from inside to outside, half-way
// between the cortex and what lies beside it (as segmentation/edge_surface.h has it), sought along the normal
// of each sample; the pose that brings the samples onto them is found by point-to-plane least squares, edges
// that disagree left out (Tukey).
[[nodiscard]] EdgePose edge_pose(const images::VolumeSampler& postop, std::span<const SurfaceSample> samples,
                                 const geometry::RigidTransform& postop_from_plan);

}  // namespace arthronaut::postop
