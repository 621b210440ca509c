// How scope, screw, probe and guide are held: poses from where things point. All in the bone's frame, mm.
#pragma once

#include <optional>

#include "navigation/tools/tool_set.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::simulator {

// Looks from eye along `forward`; `up` points to the picture's top.
[[nodiscard]] geometry::RigidTransform bone_from_camera(const Eigen::Vector3d& eye,
                                                        const Eigen::Vector3d& forward,
                                                        const Eigen::Vector3d& up);

// A marker at `center` with that normal and its y axis near `y`.
[[nodiscard]] geometry::RigidTransform marker_facing(const Eigen::Vector3d& center,
                                                     const Eigen::Vector3d& normal, const Eigen::Vector3d& y);

// `normal`, turned towards `wanted` until the angle between them is at most limit_rad.
[[nodiscard]] Eigen::Vector3d turned_towards(const Eigen::Vector3d& normal, const Eigen::Vector3d& wanted,
                                             double limit_rad);

// The probe's marker with the tip at `tip` and the marker in the direction of `hold`: of the turns about the
// line from tip to marker, the one whose marker faces the viewer but for 18 degrees, which a pose from one
// square needs. Empty when the viewer looks along that line.
[[nodiscard]] std::optional<geometry::RigidTransform> hold_probe(const Eigen::Vector3d& tip_in_probe_mm,
                                                                 const Eigen::Vector3d& tip,
                                                                 const Eigen::Vector3d& hold,
                                                                 const Eigen::Vector3d& viewer);

// The guide's marker when its point stands at `point` and its axis along `direction`, the marker turned
// towards `viewer`.
[[nodiscard]] geometry::RigidTransform guide_pose(const tools::ToolAxis& axis,
                                                  const Eigen::Vector3d& point_mm,
                                                  const Eigen::Vector3d& direction,
                                                  const Eigen::Vector3d& viewer_mm);

}  // namespace arthronaut::simulator
