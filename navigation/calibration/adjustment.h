// The joint adjustment of all pictures: one focal length, one distortion, one principal point that turns
// about one centre with the lens. Inside the module.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::calibration {

// What one picture gives to the adjustment.
struct Sighting {
  std::vector<Eigen::Vector2d> pixels, board_mm;  // pairs
  std::vector<double> sigma_px;  // of each pixel; the common scale is found from the residuals
  bool has_angle = false;
  double mark_angle_deg = 0;  // measured
  bool has_circle = false;
  Eigen::Vector2d circle_center_px = Eigen::Vector2d::Zero();
};

// The state of the adjustment. Lens angles are relative to the reference mark angle.
struct Estimate {
  double focal_px = 0, xi = 0;
  Eigen::Vector2d principal_point_px = Eigen::Vector2d::Zero();  // at lens angle 0
  Eigen::Vector2d rotation_center_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d circle_center_px = Eigen::Vector2d::Zero();  // at lens angle 0
  double reference_mark_angle_deg = 0;
  std::vector<double> lens_angle_rad;                       // one a picture
  std::vector<geometry::RigidTransform> camera_from_board;  // one a picture
};

struct AdjustmentOptions {
  bool fix_intrinsics = false;  // poses and lens angles alone
  bool turns = true;            // false: no lens angle is known, everything stands still
  // The corners' noise over their sigmas. 0: found from the residuals, in a second pass.
  double corner_scale = 0;
  bool with_covariance = false;  // costs more than the adjustment
};

struct AdjustmentResult {
  bool converged = false;
  Estimate estimate;
  double rms_px = -1;       // length of the residual vectors over all corners
  double corner_scale = 0;  // that it was made with
  double cost = 0;          // what was made least: half the sum of squares, in sigmas; outliers count less
  std::vector<std::vector<Eigen::Vector2d>> residuals_px;  // seen - expected, by picture
  // Of (focal_px, xi, principal x, y, rotation centre x, y); scaled by the residuals; 0x0 when not asked for
  // or when the pictures leave it open.
  Eigen::MatrixXd covariance;
  std::vector<double> lens_angle_sigma_rad;  // one a picture; empty with the covariance
};

[[nodiscard]] AdjustmentResult adjust(std::span<const Sighting> sightings, const Estimate& start,
                                      const AdjustmentOptions& options);

}  // namespace arthronaut::calibration
