// The pose of a marker from its measured edges: robust least squares of the distances between measured and
// projected edges, in raw pixels. A distance is taken across the edge only: along it nothing was measured.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/edge_profiles.h"
#include "navigation/markers/planar_pose.h"
#include "navigation/markers/row_timing.h"

namespace arthronaut::markers {

struct EdgePose {
  bool converged = false;
  geometry::RigidTransform camera_from_marker;
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  // body twist (v mm, w rad)
  // How much larger than they are the dark areas appear, on every edge: what blur and an inexact gamma leave.
  // It is told from the distance by the bright cells inside the dark square, which shrink where the square
  // grows.
  double bloom_px = 0;
  double scale = 0;   // residuals / their predicted sigmas
  double rms_px = 0;  // of the inliers
  int inliers = 0;
  // Inliers / samples in view that are not saturated, for edges crossed along x and along y: a marker that is
  // off by a cell keeps one of them.
  std::array<double, 2> share{};
};

// What is known of the bloom beforehand.
struct BloomPrior {
  double mean_px = 0, sigma_px = 0.2;
};

// `is_inlier` gets one entry a measurement and keeps its memory.
[[nodiscard]] EdgePose fit_edge_pose(const camera::CameraModel& camera, double size_mm,
                                     std::span<const EdgeSample> samples,
                                     std::span<const EdgeMeasurement> measurements,
                                     const geometry::RigidTransform& start, const BloomPrior& bloom,
                                     std::vector<char>& is_inlier);

// The pose whose face is tilted the other way about the line of sight, by more than is harmless, where these
// edges do not tell it from the fit for the worse; it may be much the better one. nullopt: they do.
// `corners_px`: where the fit has its corners.
inline constexpr double kHarmlessTiltRad = 3 * geometry::kPi / 180;
[[nodiscard]] std::optional<EdgePose> rival_tilt(const camera::CameraModel& camera, double size_mm,
                                                 std::span<const EdgeSample> samples,
                                                 std::span<const EdgeMeasurement> measurements,
                                                 const EdgePose& fit, const Corners& corners_px,
                                                 const BloomPrior& bloom, std::vector<char>& scratch);

// Whether the marker's left or its right half, and its upper or its lower one, lead by their own edges to
// where the fit to all of them is. What hides or bends a part leaves one of both halves as it is: where
// neither agrees the fit is between two poses, and may be neither. A half of too few edges says nothing
// against it. Gives what the fit may be off by beside its covariance: nothing, or where no half agrees as far
// as the one that does best, unless that is farther than a pose that stands may be off (nullopt). `half`
// keeps its memory, and `scratch`.
[[nodiscard]] std::optional<geometry::Matrix6d> doubt_by_halves(
    const camera::CameraModel& camera, double size_mm, std::span<const EdgeSample> samples,
    std::span<const EdgeMeasurement> measurements, const EdgePose& fit, const BloomPrior& bloom,
    std::vector<EdgeMeasurement>& half, std::vector<char>& scratch);

// What the edges of a pose say of when its rows were exposed.
[[nodiscard]] RowTrend row_trend(const camera::CameraModel& camera, double size_mm,
                                 std::span<const EdgeSample> samples,
                                 std::span<const EdgeMeasurement> measurements,
                                 std::span<const char> is_inlier, const EdgePose& pose);

struct MeasuredCorners {
  Corners corners_px;
  double rms_px = 0;  // how far they are from the pose's corners
};

// Where the outline's measured edges meet: a line is laid through each side's deviations from the pose. A
// side that is hardly seen stays where the pose puts it.
[[nodiscard]] MeasuredCorners measured_corners(const camera::CameraModel& camera, double size_mm,
                                               std::span<const EdgeSample> samples,
                                               std::span<const EdgeMeasurement> measurements,
                                               std::span<const char> is_inlier, const EdgePose& pose);

}  // namespace arthronaut::markers
