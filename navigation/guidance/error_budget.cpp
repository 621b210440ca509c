#include "navigation/guidance/error_budget.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::guidance {

TwistPerCameraError relative_twist_per_camera_error(const geometry::RigidTransform& world_marker_from_tool,
                                                    const TwistPerCameraError& world_marker,
                                                    const TwistPerCameraError& tool) {
  // (W exp(a))^-1 (G exp(b)) = exp(-a + Ad(M) b) M to first order, with M = W^-1 G.
  return geometry::adjoint(world_marker_from_tool) * tool - world_marker;
}

TwistBudget twist_budget(const registration::RegistrationSummary& registration,
                         const geometry::TrackedPose& world_marker_from_tool,
                         const TwistPerCameraError& relative_per_camera_error, const KnownErrors& known) {
  // With B = marker_from_bone: (exp(r) B)^-1 exp(m) M = exp(Ad(B^-1) (m - r)) B^-1 M. What moves registration
  // and tool alike (m = r) is not an error of one to the other.
  const geometry::Matrix6d into_bone = geometry::adjoint(registration.marker_from_bone.inverse());
  const geometry::Matrix6d camera =
      into_bone * (relative_per_camera_error - known.registration.per_camera_error);
  const Eigen::Matrix<double, 6, 3> tip = into_bone * known.registration.per_tip_error;
  const geometry::Matrix6d marker = into_bone * geometry::adjoint(world_marker_from_tool.target_from_source);
  return {.camera = camera * known.camera * camera.transpose(),
          .tools = tip * known.probe_tip_mm2 * tip.transpose(),
          .marker = marker * world_marker_from_tool.covariance * marker.transpose(),
          .registration = registration.covariance};
}

PredictedError predicted_error(const TwistBudget& budget, const Eigen::Matrix<double, 3, 6>& jacobian,
                               const Eigen::Matrix3d& own) {
  const auto square = [&](const geometry::Matrix6d& covariance) {
    return std::max((jacobian * covariance * jacobian.transpose()).trace(), 0.0);
  };
  const double camera = square(budget.camera), tools = square(budget.tools) + std::max(own.trace(), 0.0),
               marker = square(budget.marker), registration = square(budget.registration);
  return {std::sqrt(camera + tools + marker + registration), std::sqrt(camera), std::sqrt(tools),
          std::sqrt(marker), std::sqrt(registration)};
}

}  // namespace arthronaut::guidance
