// Inner header: the sightings of a body's markers as one least-squares problem, and its solution.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tools {

inline constexpr double kRigFocal_px = 600;

// One marker in one frame, with the corners that its own pose has.
struct RigView {
  std::size_t frame = 0, marker = 0;  // indices
  geometry::RigidTransform camera_from_marker;
  std::array<Eigen::Vector2d, 4> corners_px;
};

struct RigProblem {
  std::vector<double> size_mm;  // by marker; the first one is the reference
  std::vector<double> time_s;   // by frame
  std::vector<RigView> views;   // in the order of frames

  [[nodiscard]] std::size_t marker_count() const { return size_mm.size(); }
  [[nodiscard]] std::size_t frame_count() const { return time_s.size(); }
};

struct RigSolution {
  std::vector<geometry::RigidTransform> reference_from_marker;
  std::vector<geometry::RigidTransform> camera_from_body;  // by frame
  double sigma_px = 0;                                     // of a corner's coordinate, robust
  std::vector<char> is_inlier;                             // by view
};

// The corners of a square of this side about its centre.
[[nodiscard]] std::array<Eigen::Vector3d, 4> rig_corners_mm(double size_mm);
// As the plain camera shows it; nullopt behind it.
[[nodiscard]] std::optional<Eigen::Vector2d> rig_project(const Eigen::Vector3d& in_camera_mm);

// From the most agreed-on relative poses to the joint minimum. nullopt: there is none that fits.
[[nodiscard]] std::optional<RigSolution> solve_rig(const RigProblem& problem);

// Of all markers but the reference, 6 each, twists on the marker's side; see rig_calibration.h.
[[nodiscard]] Eigen::MatrixXd rig_covariance(const RigProblem& problem, const RigSolution& solution);

// The root mean square of the inliers' corners, mm across the line of sight.
[[nodiscard]] double rig_rms_mm(const RigProblem& problem, const RigSolution& solution);

}  // namespace arthronaut::tools
