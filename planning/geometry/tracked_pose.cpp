#include "planning/geometry/tracked_pose.h"

namespace arthronaut::geometry {

TrackedPose compose(const TrackedPose& target_from_middle, const TrackedPose& middle_from_source) {
  TrackedPose result;
  result.timestamp_ns = middle_from_source.timestamp_ns;
  result.is_valid = target_from_middle.is_valid && middle_from_source.is_valid &&
                    target_from_middle.timestamp_ns == middle_from_source.timestamp_ns;
  if (!result.is_valid) return result;
  result.target_from_source = target_from_middle.target_from_source * middle_from_source.target_from_source;
  const Matrix6d ad = adjoint(middle_from_source.target_from_source.inverse());
  result.covariance = ad * target_from_middle.covariance * ad.transpose() + middle_from_source.covariance;
  return result;
}

TrackedPose inverse(const TrackedPose& target_from_source) {
  TrackedPose result = target_from_source;
  result.target_from_source = target_from_source.target_from_source.inverse();
  const Matrix6d ad = adjoint(target_from_source.target_from_source);
  result.covariance = ad * target_from_source.covariance * ad.transpose();
  return result;
}

}  // namespace arthronaut::geometry
