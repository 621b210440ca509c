// The numbers of the drill guide relative to the plan. One function for the screen, the command line and the
// report.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "navigation/guidance/drill_depth.h"
#include "navigation/guidance/error_budget.h"
#include "navigation/registration/registration.h"
#include "navigation/tools/tool_set.h"
#include "planning/geometry/tracked_pose.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::guidance {

// Kept as numbers in recordings: new ones go to the end.
enum class GuidanceState {
  Valid,
  NoPlan,
  NoRegistration,
  RegistrationUnreliable,
  WorldMarkerLost,
  GuideLost,
  LensStale,
  Stale,            // the newest pose is too old
  NoGuide,          // the tools hold no such guide, or it has no axis
  WrongMedium,      // the pictures contradict the medium that is said to be before the lens
  NotConfirmed,     // the time-out of a live operation is still to be done
  GuideNotChecked,  // a live operation's guide is nominal and was not held against a known point yet
  PictureTorn,      // it is of two moments: its parts are not to be set against each other
  ErrorUnknown,     // a marker stands where nobody can say what the camera's error does to its pose
  PictureLate,      // a live picture that was too old to guide by before its numbers were known
  PicturesSlow,     // each live picture is too old to guide by before the next one is shown
  MediumUnsure,     // the pictures have not confirmed the stated medium yet, or speak against it
};
inline constexpr GuidanceState kLastGuidanceState = GuidanceState::MediumUnsure;  // records keep the number
[[nodiscard]] std::string_view to_text(GuidanceState state);

// A drill with a marker of its own, in this frame.
struct DrillInput {
  const tools::Tool* tool = nullptr;  // with a tip and an axis; else nothing is said of it
  geometry::TrackedPose camera_from_drill;
  std::optional<TwistPerCameraError> per_camera_error = TwistPerCameraError::Zero();  // as of the guide
};

struct GuidanceInput {
  const tunnels::Tunnel* plan = nullptr;  // null: NoPlan
  double planned_length_mm = 0;           // inside bone, along the plan
  landmarks::AnatomicalAxes axes;         // of the bone, in its frame
  const registration::RegistrationSummary* registration = nullptr;
  geometry::TrackedPose camera_from_world_marker;
  geometry::TrackedPose camera_from_guide;
  const tools::ToolAxis* axis = nullptr;  // of the guide, in its marker frame; null: NoGuide
  // Without one nothing is said about depth; of several it is said of the one that is seen, of more than one
  // of the one whose tip is nearest to the planned tunnel. The one that was told of before (its marker) stays
  // where another one is nearer by little, unless that one is in the tunnel, and it is not.
  std::span<const DrillInput> drills = {};
  std::optional<int> drill_before = std::nullopt;
  const geometry::Surface* bone = nullptr;  // in its frame; null: the drill's exit is the plan's alone
  bool lens_is_stale = false;
  std::int64_t now_ns = 0;
  std::int64_t max_age_ns = 100'000'000;
  // What the predicted error is made of beside the poses and the registration; zero: exact.
  const KnownErrors* known_errors = nullptr;  // null: all exact
  tools::AxisError axis_error;
  // Empty: cannot be said, which leaves no number that follows from that pose.
  std::optional<TwistPerCameraError> world_marker_per_camera_error = TwistPerCameraError::Zero();
  std::optional<TwistPerCameraError> guide_per_camera_error = TwistPerCameraError::Zero();
};

struct GuidanceNumbers {
  GuidanceState state = GuidanceState::NoPlan;
  std::int64_t timestamp_ns = 0;
  // Everything down to `drill` is meaningful when is_valid() and lies in the bone frame (LPS, mm).
  Eigen::Vector3d guide_point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d guide_direction = Eigen::Vector3d::UnitZ();
  double tip_to_entry_mm = 0;   // guide point to planned entry
  double axis_to_entry_mm = 0;  // planned entry to the guide's axis
  double angle_deg = 0;         // guide's axis to the plan's
  // The offset: where the guide's axis crosses the plane through the entry across the plan, from the entry.
  // Its length, and the same vector in the two anatomical directions of that plane (across_plan); the third
  // one, which runs along the plan, is 0. So offset_mm is the root of the sum of their squares.
  double offset_mm = 0;
  double offset_anterior_mm = 0;
  double offset_proximal_mm = 0;
  double offset_lateral_mm = 0;
  landmarks::PlaneAxes across_plan;
  double depth_mm = 0;  // of the guide's point, not of a drill, beyond the entry along the plan
  // Predicted, one sigma: root mean square of the length of the offset's error, and of the direction's.
  double sigma_offset_mm = 0;
  double sigma_angle_deg = 0;
  PredictedError offset_error_mm;  // the same, with its shares
  // Of the drill, where it is seen: whether the guide is seen or not. Empty: nobody knows how deep it is.
  std::optional<DrillDepth> drill = std::nullopt;
  [[nodiscard]] bool is_valid() const { return state == GuidanceState::Valid; }
  // It would guide, had its picture come in time.
  [[nodiscard]] bool is_too_late() const {
    return state == GuidanceState::PictureLate || state == GuidanceState::PicturesSlow;
  }
  [[nodiscard]] double offset_in_mm(landmarks::AnatomicalDirection direction) const;
};

// Where an axis crosses the plane through the plan's entry across the plan. One that lies almost in that
// plane, within 6 degrees, crosses it nowhere near: then its nearest point to the entry.
[[nodiscard]] Eigen::Vector3d crossing_of(const Eigen::Vector3d& point_mm, const Eigen::Vector3d& direction,
                                          const tunnels::Tunnel& plan);

// Allocates nothing once it has looked for a drill's exit (Surface::first_hit).
[[nodiscard]] GuidanceNumbers compute_guidance(const GuidanceInput& input);

}  // namespace arthronaut::guidance
