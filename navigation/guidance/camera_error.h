// What an error of the camera's calibration does to the pose of a marker. Every marker of a frame is seen by
// the same camera, so that their errors are correlated: what is reckoned from two of them is off by less than
// either.
#pragma once

#include <optional>
#include <span>

#include "navigation/camera/camera_model.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::guidance {

// Columns: the calibration's errors in the order of camera::CameraCovariance. Rows: body twist (v mm, w rad).
using TwistPerCameraError = Eigen::Matrix<double, 6, 6>;

// First order, by the corners: the pose found through a camera that is off by d is T * exp(result * d), where
// T is the pose that it would find without. Empty where it cannot be said: a corner has no image, as past the
// rim of the field of view, or the corners do not hold a pose. That is not "exact": what follows from such a
// pose has no error that could be told, and must not be shown. `camera` is that of the frame, with its lens
// turned. Allocates nothing.
// For a body of several markers: its corners, all alike in weight, in its frame.
[[nodiscard]] std::optional<TwistPerCameraError> twist_per_camera_error(
    const geometry::RigidTransform& camera_from_body, std::span<const Eigen::Vector3d> corners_mm,
    const camera::CameraModel& camera);
// For one marker.
[[nodiscard]] std::optional<TwistPerCameraError> twist_per_camera_error(
    const geometry::RigidTransform& camera_from_marker, double size_mm, const camera::CameraModel& camera);

}  // namespace arthronaut::guidance
