#include "navigation/tools/body_marker.h"

#include <algorithm>

namespace arthronaut::tools {

geometry::Matrix6d placement_covariance(const BodyMarker& marker) {
  constexpr double kUnsaid_mm = 0.03, kUnsaid_deg = 0.2;
  const geometry::RigidTransform& at = marker.body_from_marker;
  const bool is_frame = at.translation_mm.isZero(0) && at.rotation.vec().isZero(0);
  const double sigma_mm = marker.sigma_mm.value_or(is_frame ? 0 : kUnsaid_mm);
  const double sigma_rad = geometry::rad_from_deg(marker.sigma_deg.value_or(is_frame ? 0 : kUnsaid_deg));
  geometry::Vector6d variance;
  variance << Eigen::Vector3d::Constant(sigma_mm * sigma_mm),
      Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  return variance.asDiagonal();
}

bool lie_on_one_another(const BodyMarker& a, const BodyMarker& b) {
  const Eigen::Vector3d normal_a = a.body_from_marker.rotate(Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d normal_b = b.body_from_marker.rotate(Eigen::Vector3d::UnitZ());
  const double apart_mm = (a.body_from_marker.translation_mm - b.body_from_marker.translation_mm).norm();
  return normal_a.dot(normal_b) > 0.5 && apart_mm < (a.size_mm + b.size_mm) / 4;
}

bool are_same(const std::vector<BodyMarker>& a, const std::vector<BodyMarker>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const BodyMarker& x, const BodyMarker& y) {
    return x.marker_id == y.marker_id && x.size_mm == y.size_mm &&
           x.body_from_marker.translation_mm == y.body_from_marker.translation_mm &&
           x.body_from_marker.rotation.coeffs() == y.body_from_marker.rotation.coeffs();
  });
}

}  // namespace arthronaut::tools
