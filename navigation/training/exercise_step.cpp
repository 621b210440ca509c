#include "navigation/training/exercise_step.h"

#include <cmath>

namespace arthronaut::training {

namespace {

// Bone between the lens and the tip, and not only what the tip lies on.
bool is_behind_bone(const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& lens_mm,
                    const geometry::Surface& bone) {
  constexpr double kLiesOn_mm = 2;
  const Eigen::Vector3d way_mm = tip_mm - lens_mm;
  const double length_mm = way_mm.norm();
  if (length_mm < kLiesOn_mm) return false;
  const auto hit = bone.first_hit(lens_mm, way_mm / length_mm);
  return hit && hit->distance_mm < length_mm - kLiesOn_mm;
}

}  // namespace

std::string exercise_step(Goal goal, const operation::OperationState& state,
                          const simulator::HandState& hand) {
  const bool holds_probe = hand.held == simulator::Held::Probe;
  switch (goal) {
    case Goal::Calibrate:
      return "";
    case Goal::Pivot:
      if (!holds_probe) return "take the probe: G";
      return hand.touches_bone ? "tilt the handle to all sides, then Enter: done"
                               : "set the probe's tip on the bone";
    case Goal::Aim:
      if (holds_probe) return "take the guide: G";
      if (state.frame.guidance.state == guidance::GuidanceState::WorldMarkerLost)
        return "bring the bone's marker into view";
      // What is away is looked for at once: there is no bullseye to follow.
      return state.guided_lately && state.frame.guidance.state != guidance::GuidanceState::GuideLost
                 ? "follow the bullseye; on the plan: Enter, done"
                 : "bring the guide into view";
    case Goal::Register:
      return state.verification == operation::Verification::ByTouches ? "verified: Enter, done" : "";
    case Goal::Drill:
      return state.drilled.outcome == operation::DrilledState::Outcome::Recorded ? "drilled: Enter, done"
                                                                                 : "";
  }
  return "";
}

std::string way_back_into_view(const simulator::HandState& hand, const camera::CameraModel& lens,
                               const geometry::Surface& bone) {
  constexpr double kNearest_mm = 1;
  const Eigen::Vector3d tip_mm =
      hand.held == simulator::Held::Probe ? hand.probe_tip_mm : hand.guide_point_mm;
  const Eigen::Vector3d in_camera_mm = hand.bone_from_camera.inverse() * tip_mm;
  if (in_camera_mm.z() < kNearest_mm) return "beside the lens, E brings it back";
  const auto pixel = lens.project(in_camera_mm);
  if (pixel && lens.is_inside_view(*pixel))
    return is_behind_bone(tip_mm, hand.bone_from_camera.translation_mm, bone)
               ? "behind the bone, Q brings it back"
               : "";
  // Beyond what any ray reaches its direction is left.
  const Eigen::Vector2d aside =
      pixel ? Eigen::Vector2d(*pixel - lens.boundary().center_px) : Eigen::Vector2d(in_camera_mm.head<2>());
  if (std::abs(aside.x()) > std::abs(aside.y()))
    return aside.x() > 0 ? "right of the picture, A brings it back" : "left of the picture, D brings it back";
  return aside.y() > 0 ? "below the picture, W brings it back" : "above the picture, S brings it back";
}

std::string ways_of_keys(const simulator::HandState& hand, const landmarks::AnatomicalAxes& axes) {
  using landmarks::AnatomicalDirection;
  const auto name_of = [&](const Eigen::Vector3d& in_picture) {
    const Eigen::Vector3d way = hand.bone_from_camera.rotate(in_picture);
    const Eigen::Vector3d along(way.dot(axes.anterior), way.dot(axes.proximal), way.dot(axes.lateral));
    Eigen::Index most = 0;
    along.cwiseAbs().maxCoeff(&most);
    constexpr AnatomicalDirection kDirections[] = {
        AnatomicalDirection::Anterior, AnatomicalDirection::Proximal, AnatomicalDirection::Lateral};
    return std::string(landmarks::to_text(kDirections[most], along[most] > 0));
  };
  return "D " + name_of(Eigen::Vector3d::UnitX()) + ", W " + name_of(-Eigen::Vector3d::UnitY()) + ", E " +
         name_of(Eigen::Vector3d::UnitZ());
}

}  // namespace arthronaut::training
