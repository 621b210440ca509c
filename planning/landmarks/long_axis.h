// The long axis of a shaft. Inner header of landmarks.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "planning/geometry/triangle_mesh.h"
#include "planning/landmarks/rough_frame.h"

namespace arthronaut::landmarks {

struct LongAxis {
  Eigen::Vector3d joint_end_mm, far_end_mm;  // of the stretch that it was fitted to, on the axis
  [[nodiscard]] Eigen::Vector3d away() const { return (far_end_mm - joint_end_mm).normalized(); }
  [[nodiscard]] double length_mm() const { return (far_end_mm - joint_end_mm).norm(); }
};

// How far along `away`, the unit direction from the joint into the shaft, beyond `joint_mm` cross sections
// are whole: to the end of the bone, or to where a cut across it begins, however it slants.
[[nodiscard]] double whole_until(const geometry::TriangleMesh& mesh, const RoughFrame& rough,
                                 const Eigen::Vector3d& joint_mm, const Eigen::Vector3d& away);

// The straight line through the centres of the cross sections across `away`, the unit direction from the
// joint into the shaft, from `first_mm` to at most `last_mm` along it beyond `joint_mm`, where the sections
// are whole: a cut across the shaft ends them. nullopt where that is less than 8 mm.
[[nodiscard]] std::optional<LongAxis> find_long_axis(const geometry::TriangleMesh& mesh,
                                                     const RoughFrame& rough, const Eigen::Vector3d& joint_mm,
                                                     const Eigen::Vector3d& away, double first_mm,
                                                     double last_mm);

}  // namespace arthronaut::landmarks
