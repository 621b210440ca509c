// Finds the tip of a pointer that was pivoted about a fixed point.
//
// The tool is swung on its tip, which rests in a dimple that is rigid to the frame the poses are given in:
// the world marker's, or the camera's when the scope is clamped. For every pose R_i tip + t_i = pivot. Solved
// by least median of squares over triples of poses, then by iteratively re-weighted least squares (Tukey).
// Rigid tools with a pointed or ball tip only: of a ball it gives the centre.
//
// A small residual does not make a good tip: swung through a narrow cone, every tip along the shaft fits
// alike. So the covariance, the bias that the noise of the orientations causes, and the difference between
// the two halves of the motion decide, not the residual.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tools {

struct PivotCalibrationOptions {
  // Poses that differ from each other by more than min_step_deg count as distinct.
  double min_step_deg = 1.0;
  int min_distinct_poses = 20;
  // Half-angle of the cone about the mean shaft that holds 95 % of the inliers.
  double min_cone_deg = 20.0;
  double max_rms_mm = 0.5;           // of the inliers, 3D
  double max_sigma_mm = 0.08;        // largest principal one-sigma of the tip
  double max_bias_mm = 0.1;          // predicted shortening along the shaft by the noise of the orientations
  double max_half_change_mm = 0.25;  // tip and pivot of the motion's first half against the second's
  double min_inlier_share = 0.6;
  std::uint32_t seed = 1;
};

struct PivotCalibrationSummary {
  enum class Outcome {
    NotRun,
    TooFewPoses,
    NoPivot,  // no three poses agree on a tip: there is none to report
    TooManyOutliers,
    ConeTooNarrow,
    ResidualTooLarge,
    TipUncertain,  // sigma, bias or the halves
    Ok,
  } outcome = Outcome::NotRun;
  std::string message = "calibrate_pivot was not called.";
  std::vector<std::string> reasons;  // every limit that is broken, in plain words; empty when Ok

  // Meaningful when has_tip(); to be used only when is_usable().
  Eigen::Vector3d tip_in_tool_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d pivot_in_fixed_mm = Eigen::Vector3d::Zero();
  // In the tool frame; of poses that rest or repeat no smaller than one of each tells, see grouped_scatter.h.
  Eigen::Matrix3d tip_covariance_mm2 = Eigen::Matrix3d::Zero();
  double rms_mm = -1;   // 3D residual of the inliers
  double cone_deg = 0;  // half-angle, see the options
  double sigma_mm = -1, bias_mm = -1;
  // Of tip or pivot, whichever is more; below 0: not known, since one half alone does not tell a tip.
  double half_change_mm = -1;
  Eigen::Vector3d tip_change_mm = Eigen::Vector3d::Zero();  // from the first half to the second, in the tool
  int pose_count = 0, inlier_count = 0, distinct_count = 0;
  std::vector<bool> is_inlier;  // one for each pose
  // How the shaft was tilted in each pose from its mean direction, about two fixed axes: the cone as it
  // fills.
  std::vector<Eigen::Vector2d> tilt_deg;

  // What tools.json keeps of how well the tip is known: the covariance, the predicted bias along the shaft,
  // and what the halves differ by beyond chance.
  [[nodiscard]] Eigen::Matrix3d tip_error_mm2() const;
  [[nodiscard]] bool has_tip() const { return outcome > Outcome::NoPivot; }
  [[nodiscard]] bool is_usable() const { return outcome == Outcome::Ok; }
};

// fixed_from_tool in order of time. Never throws on poor data: read the summary. Throws InvalidInput when an
// option is out of range (a limit that is not above 0, a share outside (0, 1]).
[[nodiscard]] PivotCalibrationSummary calibrate_pivot(
    std::span<const geometry::RigidTransform> fixed_from_tool, const PivotCalibrationOptions& options = {});

}  // namespace arthronaut::tools
