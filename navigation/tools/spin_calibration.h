// Finds the axis of a guide that was turned about it in a fixed sleeve.
//
// All orientations share one axis: it is the right singular vector of the mean rotation with the largest
// singular value (in the tool frame), and the left one (in the fixed frame). A point of the axis follows from
// R_i p + t_i = c + s_i d by least squares across the axis; it is given as the foot of the marker's origin on
// the axis.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tools {

struct SpinCalibrationOptions {
  int min_poses = 20;
  double min_turn_deg = 90;  // from the first orientation to the last, over the inliers
  // Two orientations alone have an axis that fits them exactly, whatever their noise: places that lie more
  // than min_step_deg apart on the turn, over the inliers.
  double min_step_deg = 5;
  int min_distinct_places = 8;
  double min_inlier_share = 0.6;
  double max_rms_mm = 0.5;  // distance of the turned axis point from the fixed axis, inliers
  double max_direction_sigma_deg = 0.2;
  double outlier_factor = 4.0;  // a pose is rejected when its error > factor * median error
  // Turning tells the line, not which way along it is drilled. The way that is declared, in the tool's frame,
  // where one is; else guides are taken to point along -y, and within this of across it there is no telling.
  std::optional<Eigen::Vector3d> declared_direction;
  double least_slope_deg = 20;
};

struct SpinCalibrationSummary {
  enum class Outcome {
    NotRun,
    TooFewPoses,
    TooManyOutliers,
    TurnTooSmall,
    TooFewPlaces,
    ResidualTooLarge,
    AxisUncertain,
    DirectionUnknown,
    Ok
  } outcome = Outcome::NotRun;
  std::string message = "calibrate_spin was not called.";
  std::vector<std::string> reasons;
  Eigen::Vector3d axis_point_in_tool_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis_direction_in_tool =
      Eigen::Vector3d::Zero();  // unit; its sign is that with the smaller angle to declared_direction, or -y
  double rms_mm = -1;
  double wobble_deg = -1;  // of the axis about its mean, RMS over the inliers
  // One sigma, of poses that rest or repeat no smaller than one of each tells, see grouped_scatter.h; never
  // below what the markers' own errors leave.
  double direction_sigma_deg = -1;
  // One sigma of the axis point, each coordinate across the axis: what the residual leaves after averaging
  // over the sector that was turned. At another point of the axis the direction's comes on top, by its
  // distance.
  double point_sigma_mm = -1;
  double turn_deg = 0;
  int pose_count = 0, inlier_count = 0, place_count = 0;
  [[nodiscard]] bool has_axis() const { return outcome > Outcome::TooFewPoses; }
  [[nodiscard]] bool is_usable() const { return outcome == Outcome::Ok; }
};

// fixed_from_tool in any order. Never throws on poor data. Throws InvalidInput when an option is not above 0.
[[nodiscard]] SpinCalibrationSummary calibrate_spin(std::span<const geometry::RigidTransform> fixed_from_tool,
                                                    const SpinCalibrationOptions& options = {});

}  // namespace arthronaut::tools
