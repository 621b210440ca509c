// The predicted error of what is said about a tool in the bone's frame: from the markers' poses, the
// calibrations of camera and tools, and the registration, with what these have in common. First order
// throughout; checked by `arthronaut experiment predicted-error`. Nothing here allocates.
#pragma once

#include "navigation/camera/camera_model.h"
#include "navigation/guidance/camera_error.h"
#include "navigation/guidance/registration_bias.h"
#include "navigation/registration/registration.h"
#include "planning/geometry/tracked_pose.h"

namespace arthronaut::guidance {

// One predicted error and what it is made of: the squares of the shares add up to the total's. Root mean
// square of the length of the error, in the unit of what it is of.
struct PredictedError {
  double total = 0;
  double camera = 0;        // calibration: focal length, distortion, principal point, centre of rotation
  double tools = 0;         // the tool's own geometry, and the probe's tip that drew the registration
  double marker = 0;        // the poses of this frame
  double registration = 0;  // strokes, noise and the bone's shape; without the probe's and the camera's share
};

// What camera and tools are known to. All zero: taken as exact.
struct KnownErrors {
  camera::CameraCovariance camera = camera::CameraCovariance::Zero();
  Eigen::Matrix3d probe_tip_mm2 = Eigen::Matrix3d::Zero();  // of the probe that drew the registration
  RegistrationBias registration;
};

// Both markers together: marker_from_tool, and how it moves with the camera's error, as a twist on its left,
// about the world marker's frame.
[[nodiscard]] TwistPerCameraError relative_twist_per_camera_error(
    const geometry::RigidTransform& world_marker_from_tool, const TwistPerCameraError& world_marker,
    const TwistPerCameraError& tool);

// Of a tool's place in the bone: covariances of the twist on the left of bone_from_tool, about the bone's
// frame.
struct TwistBudget {
  geometry::Matrix6d camera, tools, marker, registration;
};
// world_marker_from_tool: composed from the two markers, with the covariance of its body twist.
[[nodiscard]] TwistBudget twist_budget(const registration::RegistrationSummary& registration,
                                       const geometry::TrackedPose& world_marker_from_tool,
                                       const TwistPerCameraError& relative_per_camera_error,
                                       const KnownErrors& known);

// The error of a quantity of up to three coordinates that moves by `jacobian` times that twist, and by the
// tool's own geometry with the covariance `own`.
[[nodiscard]] PredictedError predicted_error(const TwistBudget& budget,
                                             const Eigen::Matrix<double, 3, 6>& jacobian,
                                             const Eigen::Matrix3d& own);

}  // namespace arthronaut::guidance
