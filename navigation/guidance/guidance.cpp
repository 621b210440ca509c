#include "navigation/guidance/guidance.h"

#include <Eigen/Geometry>
#include <cmath>

namespace arthronaut::guidance {

namespace {

// A guide that advances less than this along the plan, as a cosine, lies almost across it.
constexpr double kLeastAdvance = 0.1;

using geometry::cross_matrix;
using geometry::TrackedPose;

// What the guide and a drill need alike, in the order in which a user can mend it.
GuidanceState missing_world(const GuidanceInput& input) {
  if (input.registration == nullptr || !input.registration->has_pose) return GuidanceState::NoRegistration;
  if (!input.registration->reliable) return GuidanceState::RegistrationUnreliable;
  if (input.lens_is_stale) return GuidanceState::LensStale;
  if (!input.camera_from_world_marker.is_valid) return GuidanceState::WorldMarkerLost;
  if (!input.camera_from_world_marker.is_usable_at(input.now_ns, input.max_age_ns))
    return GuidanceState::Stale;
  return GuidanceState::Valid;
}

GuidanceState missing_input(const GuidanceInput& input) {
  if (input.plan == nullptr) return GuidanceState::NoPlan;
  if (input.axis == nullptr) return GuidanceState::NoGuide;
  const GuidanceState world = missing_world(input);
  // A guide that is out of view is said before a pose that is old.
  if (world != GuidanceState::Valid && world != GuidanceState::Stale) return world;
  if (!input.camera_from_guide.is_valid) return GuidanceState::GuideLost;
  if (world == GuidanceState::Stale || !input.camera_from_guide.is_usable_at(input.now_ns, input.max_age_ns))
    return GuidanceState::Stale;
  if (!input.world_marker_per_camera_error || !input.guide_per_camera_error)
    return GuidanceState::ErrorUnknown;
  return GuidanceState::Valid;
}

// How the crossing of an axis with the plane through the entry moves with it: by what is across the axis, run
// along it back into the plane.
Eigen::Matrix3d into_plane(const Eigen::Vector3d& direction, const Eigen::Vector3d& plan_direction) {
  const Eigen::Matrix3d across_plan =
      Eigen::Matrix3d::Identity() - plan_direction * plan_direction.transpose();
  const double advance = direction.dot(plan_direction);
  if (std::abs(advance) > kLeastAdvance)
    return Eigen::Matrix3d::Identity() - direction * plan_direction.transpose() / advance;
  return across_plan * (Eigen::Matrix3d::Identity() - direction * direction.transpose());
}

void put_offset(landmarks::AnatomicalDirection direction, double value_mm, GuidanceNumbers& numbers) {
  switch (direction) {
    case landmarks::AnatomicalDirection::Anterior:
      numbers.offset_anterior_mm = value_mm;
      return;
    case landmarks::AnatomicalDirection::Proximal:
      numbers.offset_proximal_mm = value_mm;
      return;
    case landmarks::AnatomicalDirection::Lateral:
      numbers.offset_lateral_mm = value_mm;
      return;
  }
}

// One tool's place in the bone, and what is not known about it.
struct Placed {
  geometry::RigidTransform bone_from_tool;
  TwistBudget budget;
};
// Empty where the two markers were seen in different frames. What the camera's error does to both is known.
std::optional<Placed> place(const GuidanceInput& input, const TrackedPose& camera_from_tool,
                            const TwistPerCameraError& tool_per_camera_error) {
  const TrackedPose marker_from_tool = compose(inverse(input.camera_from_world_marker), camera_from_tool);
  if (!marker_from_tool.is_valid) return std::nullopt;
  static const KnownErrors kExact;
  return Placed{input.registration->marker_from_bone.inverse() * marker_from_tool.target_from_source,
                twist_budget(*input.registration, marker_from_tool,
                             relative_twist_per_camera_error(marker_from_tool.target_from_source,
                                                             *input.world_marker_per_camera_error,
                                                             tool_per_camera_error),
                             input.known_errors != nullptr ? *input.known_errors : kExact)};
}

// A tool's axis in the bone's frame, and how well it is known in the tool itself.
struct PlacedAxis {
  Eigen::Vector3d point_mm, direction;
  Eigen::Matrix3d point_error_mm2;
  double direction_sigma_rad = 0;
};

struct AxisErrors {
  PredictedError offset_mm, angle_deg;
};

AxisErrors predict_errors(const PlacedAxis& axis, const TwistBudget& budget, const tunnels::Tunnel& plan) {
  const Eigen::Vector3d crossing = crossing_of(axis.point_mm, axis.direction, plan);
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis.direction * axis.direction.transpose();
  const Eigen::Matrix3d in_plane = into_plane(axis.direction, plan.direction.normalized());
  // A point p of the axis moves by v - [p]x w, a direction g by -[g]x w.
  Eigen::Matrix<double, 3, 6> move;
  move << in_plane, -in_plane * cross_matrix(crossing);
  const double reach_mm = (crossing - axis.point_mm).norm();
  const Eigen::Matrix3d own_mm2 =
      axis.point_error_mm2 + std::pow(reach_mm * axis.direction_sigma_rad, 2) * across;
  Eigen::Matrix<double, 3, 6> turn;
  turn << Eigen::Matrix3d::Zero(), -geometry::deg_from_rad(1) * cross_matrix(axis.direction);
  const double own_deg = geometry::deg_from_rad(axis.direction_sigma_rad);
  return {predicted_error(budget, move, in_plane * own_mm2 * in_plane.transpose()),
          predicted_error(budget, turn, own_deg * own_deg * across)};
}

// A drill by its own marker, as the plan alone has it.
std::optional<DrillDepth> seen_drill(const GuidanceInput& input, const DrillInput& seen) {
  if (seen.tool == nullptr || !seen.tool->tip_mm || !seen.tool->axis ||
      !seen.camera_from_drill.is_usable_at(input.now_ns, input.max_age_ns) || !seen.per_camera_error)
    return std::nullopt;
  const auto placed = place(input, seen.camera_from_drill, *seen.per_camera_error);
  if (!placed) return std::nullopt;
  const Eigen::Matrix3d turned = placed->bone_from_tool.matrix();
  const Eigen::Vector3d tip = placed->bone_from_tool * *seen.tool->tip_mm;
  const Eigen::Matrix3d tip_error_mm2 = turned * tools::tip_error_mm2(*seen.tool) * turned.transpose();
  const auto sigma_along = [&](const Eigen::Vector3d& along) {  // of the tip, in that one coordinate
    Eigen::Matrix<double, 3, 6> move = Eigen::Matrix<double, 3, 6>::Zero();
    move.row(0) << along.transpose(), -along.transpose() * cross_matrix(tip);
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
    own(0, 0) = along.dot(tip_error_mm2 * along);
    return predicted_error(placed->budget, move, own).total;
  };
  const PlacedAxis axis{tip, (turned * seen.tool->axis->direction).normalized(), tip_error_mm2,
                        tools::axis_error(*seen.tool).direction_sigma_rad};
  DrillDepth drill =
      drill_depth(*input.plan, input.planned_length_mm, tip, axis.direction,
                  std::max(sigma_along(input.plan->direction.normalized()), sigma_along(axis.direction)));
  drill.marker_id = seen.tool->marker_id;
  const AxisErrors errors = predict_errors(axis, placed->budget, *input.plan);
  drill.sigma_offset_mm = errors.offset_mm.total;
  drill.sigma_angle_deg = errors.angle_deg.total;
  return drill;
}

// Of several that are seen the one that this tunnel is drilled with.
std::optional<DrillDepth> nearest_drill(const GuidanceInput& input) {
  if (input.plan == nullptr || missing_world(input) != GuidanceState::Valid ||
      !input.world_marker_per_camera_error)
    return std::nullopt;
  std::optional<DrillDepth> nearest, before;
  for (const DrillInput& seen : input.drills) {
    const std::optional<DrillDepth> drill = seen_drill(input, seen);
    if (drill && (!nearest || from_tunnel_mm(*drill) < from_tunnel_mm(*nearest))) nearest = drill;
    if (drill && input.drill_before == drill->marker_id) before = drill;
  }
  constexpr double kClearlyNearer_mm = 2;
  const bool hides_another = nearest && before && nearest->depth_mm > 0 && before->depth_mm <= 0;
  if (before && !hides_another && from_tunnel_mm(*before) - from_tunnel_mm(*nearest) < kClearlyNearer_mm)
    nearest = before;
  if (nearest && input.bone != nullptr) hold_against(*input.bone, *nearest);
  return nearest;
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
    case GuidanceState::NoGuide:
      return "no drill guide with an axis";
    case GuidanceState::WrongMedium:
      return "wrong medium";
    case GuidanceState::NotConfirmed:
      return "time-out not confirmed";
    case GuidanceState::GuideNotChecked:
      return "nominal drill guide not checked";
    case GuidanceState::PictureTorn:
      return "picture torn";
    case GuidanceState::ErrorUnknown:
      return "error of the pose not known";
    case GuidanceState::PictureLate:
      return "picture too late";
    case GuidanceState::PicturesSlow:
      return "pictures come too slowly";
    case GuidanceState::MediumUnsure:
      return "medium not confirmed by the picture";
  }
  return "unknown";
}

double GuidanceNumbers::offset_in_mm(landmarks::AnatomicalDirection direction) const {
  switch (direction) {
    case landmarks::AnatomicalDirection::Anterior:
      return offset_anterior_mm;
    case landmarks::AnatomicalDirection::Proximal:
      return offset_proximal_mm;
    case landmarks::AnatomicalDirection::Lateral:
      return offset_lateral_mm;
  }
  return 0;
}

Eigen::Vector3d crossing_of(const Eigen::Vector3d& point_mm, const Eigen::Vector3d& direction,
                            const tunnels::Tunnel& plan) {
  const Eigen::Vector3d along = plan.direction.normalized();
  const double advance = direction.dot(along);
  const Eigen::Vector3d to_entry = plan.entry_mm - point_mm;
  const double way_mm =
      std::abs(advance) > kLeastAdvance ? to_entry.dot(along) / advance : to_entry.dot(direction);
  return point_mm + way_mm * direction;
}

GuidanceNumbers compute_guidance(const GuidanceInput& input) {
  GuidanceNumbers numbers;
  numbers.timestamp_ns = input.camera_from_guide.timestamp_ns;
  numbers.drill = nearest_drill(input);
  numbers.state = missing_input(input);
  if (numbers.state != GuidanceState::Valid) return numbers;
  const auto placed = place(input, input.camera_from_guide, *input.guide_per_camera_error);
  if (!placed) {
    numbers.state = GuidanceState::Stale;
    return numbers;
  }
  const Eigen::Vector3d point = placed->bone_from_tool * input.axis->point_mm;
  const Eigen::Vector3d direction = placed->bone_from_tool.rotate(input.axis->direction).normalized();
  const Eigen::Vector3d& entry = input.plan->entry_mm;
  const Eigen::Vector3d plan_direction = input.plan->direction.normalized();

  numbers.guide_point_mm = point;
  numbers.guide_direction = direction;
  numbers.tip_to_entry_mm = (point - entry).norm();
  numbers.axis_to_entry_mm = (entry - point).cross(direction).norm();
  numbers.angle_deg = geometry::deg_from_rad(geometry::angle_between_rad(direction, plan_direction));
  numbers.depth_mm = (point - entry).dot(plan_direction);

  const Eigen::Vector3d crossing = crossing_of(point, direction, *input.plan);
  numbers.across_plan = landmarks::axes_across(input.axes, plan_direction);
  const double up_mm = (crossing - entry).dot(numbers.across_plan.up);
  const double side_mm = (crossing - entry).dot(numbers.across_plan.side);
  numbers.offset_mm = std::hypot(up_mm, side_mm);
  put_offset(numbers.across_plan.up_is, up_mm, numbers);
  put_offset(numbers.across_plan.side_is, side_mm, numbers);
  const double point_sigma_mm = input.axis_error.point_sigma_mm;
  const AxisErrors errors =
      predict_errors({point, direction, point_sigma_mm * point_sigma_mm * Eigen::Matrix3d::Identity(),
                      input.axis_error.direction_sigma_rad},
                     placed->budget, *input.plan);
  numbers.offset_error_mm = errors.offset_mm;
  numbers.sigma_offset_mm = errors.offset_mm.total;
  numbers.sigma_angle_deg = errors.angle_deg.total;
  return numbers;
}

}  // namespace arthronaut::guidance
