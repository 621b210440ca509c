#include "navigation/guidance/guidance.h"

#include <Eigen/Dense>
#include <cmath>

namespace arthronaut::guidance {

namespace {

using geometry::cross_matrix;
using geometry::TrackedPose;

// The first thing that is missing, in the order in which a user can mend it.
GuidanceState missing_input(const GuidanceInput& input) {
  if (input.plan == nullptr || input.axis == nullptr) return GuidanceState::NoPlan;
  if (input.registration == nullptr || !input.registration->has_pose) return GuidanceState::NoRegistration;
  if (!input.registration->reliable) return GuidanceState::RegistrationUnreliable;
  if (input.lens_is_stale) return GuidanceState::LensStale;
  if (!input.camera_from_world_marker.is_valid) return GuidanceState::WorldMarkerLost;
  if (!input.camera_from_guide.is_valid) return GuidanceState::GuideLost;
  if (!input.camera_from_world_marker.is_usable_at(input.now_ns, input.max_age_ns) ||
      !input.camera_from_guide.is_usable_at(input.now_ns, input.max_age_ns)) {
    return GuidanceState::Stale;
  }
  return GuidanceState::Valid;
}

// Part of `axis` that lies in the plane across `normal`, unit; zero where the axis stands on the plane.
Eigen::Vector3d laid_into_plane(const Eigen::Vector3d& axis, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d in_plane = axis - axis.dot(normal) * normal;
  const double length = in_plane.norm();
  return length > 1e-6 ? Eigen::Vector3d(in_plane / length) : Eigen::Vector3d::Zero();
}

// Where the guide's axis crosses the plane through the entry across the plan; a guide that lies almost in
// that plane crosses it nowhere near, and its nearest point is taken instead.
Eigen::Vector3d crossing_of(const Eigen::Vector3d& guide_point, const Eigen::Vector3d& guide_direction,
                            const Eigen::Vector3d& entry, const Eigen::Vector3d& plan_direction) {
  const double advance = guide_direction.dot(plan_direction);
  const double along = std::abs(advance) > 0.1 ? (entry - guide_point).dot(plan_direction) / advance
                                               : (entry - guide_point).dot(guide_direction);
  return guide_point + along * guide_direction;
}

}  // namespace

std::string_view to_text(GuidanceState state) {
  switch (state) {
    case GuidanceState::Valid:
      return "valid";
    case GuidanceState::NoPlan:
      return "no plan";
    case GuidanceState::NoRegistration:
      return "no registration";
    case GuidanceState::RegistrationUnreliable:
      return "registration not reliable";
    case GuidanceState::WorldMarkerLost:
      return "world marker not seen";
    case GuidanceState::GuideLost:
      return "drill guide not seen";
    case GuidanceState::LensStale:
      return "lens mark not seen";
    case GuidanceState::Stale:
      return "pose too old";
  }
  return "unknown";
}

GuidanceNumbers compute_guidance(const GuidanceInput& input) {
  GuidanceNumbers numbers;
  numbers.timestamp_ns = input.camera_from_guide.timestamp_ns;
  numbers.state = missing_input(input);
  if (numbers.state != GuidanceState::Valid) return numbers;

  const TrackedPose marker_from_guide =
      compose(inverse(input.camera_from_world_marker), input.camera_from_guide);
  if (!marker_from_guide.is_valid) {  // the two markers were seen in different frames
    numbers.state = GuidanceState::Stale;
    return numbers;
  }
  const geometry::RigidTransform bone_from_marker = input.registration->marker_from_bone.inverse();
  const geometry::RigidTransform bone_from_guide = bone_from_marker * marker_from_guide.target_from_source;
  const Eigen::Vector3d point = bone_from_guide * input.axis->point_mm;
  const Eigen::Vector3d direction = bone_from_guide.rotate(input.axis->direction).normalized();
  const Eigen::Vector3d& entry = input.plan->entry_mm;
  const Eigen::Vector3d plan_direction = input.plan->direction.normalized();

  numbers.guide_point_mm = point;
  numbers.guide_direction = direction;
  numbers.tip_to_entry_mm = (point - entry).norm();
  numbers.axis_to_entry_mm = (entry - point).cross(direction).norm();
  numbers.angle_deg = geometry::deg_from_rad(geometry::angle_between_rad(direction, plan_direction));
  numbers.depth_mm = (point - entry).dot(plan_direction);
  numbers.remaining_mm = input.planned_length_mm - numbers.depth_mm;

  // LPS: anterior is -y, proximal +z for either bone and side.
  const Eigen::Vector3d offset = crossing_of(point, direction, entry, plan_direction) - entry;
  numbers.offset_anterior_mm = offset.dot(laid_into_plane(-Eigen::Vector3d::UnitY(), plan_direction));
  numbers.offset_proximal_mm = offset.dot(laid_into_plane(Eigen::Vector3d::UnitZ(), plan_direction));

  // Predicted error of the guide's axis at the entry: the registration's at that point, and the tracked
  // pose's seen through the guide's axis. Both are body twists (v, w): a point p of the body moves by v -
  // [p]x w.
  const geometry::Matrix6d& tracking = marker_from_guide.covariance;
  const Eigen::Vector3d entry_in_guide = bone_from_guide.inverse() * entry;
  Eigen::Matrix<double, 3, 6> move;
  move << Eigen::Matrix3d::Identity(), -cross_matrix(entry_in_guide);
  const double registration_mm = registration::predicted_error_mm(*input.registration, entry);
  numbers.sigma_offset_mm =
      std::sqrt(registration_mm * registration_mm + (move * tracking * move.transpose()).trace());
  const Eigen::Matrix3d across_plan = cross_matrix(plan_direction),
                        across_guide = cross_matrix(input.axis->direction);
  const Eigen::Matrix3d turn_registration = input.registration->covariance.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d turn_tracking = tracking.bottomRightCorner<3, 3>();
  numbers.sigma_angle_deg =
      geometry::deg_from_rad(std::sqrt((across_plan * turn_registration * across_plan.transpose()).trace() +
                                       (across_guide * turn_tracking * across_guide.transpose()).trace()));
  return numbers;
}

}  // namespace arthronaut::guidance
