// The numbers of the drill guide relative to the plan. One function for the screen, the command line and the
// report.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "navigation/registration/registration.h"
#include "navigation/tools/tool_set.h"
#include "planning/geometry/tracked_pose.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::guidance {

enum class GuidanceState {
  Valid,
  NoPlan,
  NoRegistration,
  RegistrationUnreliable,
  WorldMarkerLost,
  GuideLost,
  LensStale,
  Stale,  // the newest pose is too old
};
[[nodiscard]] std::string_view to_text(GuidanceState state);

struct GuidanceInput {
  const tunnels::Tunnel* plan = nullptr;  // null: NoPlan
  double planned_length_mm = 0;           // inside bone, along the plan
  bones::Side side = bones::Side::Right;
  const registration::RegistrationSummary* registration = nullptr;
  geometry::TrackedPose camera_from_world_marker;
  geometry::TrackedPose camera_from_guide;
  const tools::ToolAxis* axis = nullptr;  // of the guide, in its marker frame
  bool lens_is_stale = false;
  std::int64_t now_ns = 0;
  std::int64_t max_age_ns = 100'000'000;
};

struct GuidanceNumbers {
  GuidanceState state = GuidanceState::NoPlan;
  std::int64_t timestamp_ns = 0;
  // Everything below is meaningful when is_valid() and lies in the bone frame (LPS, mm).
  Eigen::Vector3d guide_point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d guide_direction = Eigen::Vector3d::UnitZ();
  double tip_to_entry_mm = 0;   // guide point to planned entry
  double axis_to_entry_mm = 0;  // planned entry to the guide's axis
  double angle_deg = 0;         // guide's axis to the plan's
  // The axis' offset where it crosses the plane through the entry across the plan, in two anatomical axes:
  // the bone's anterior(+)/posterior(-) and proximal(+)/distal(-) directions laid into that plane.
  double offset_anterior_mm = 0;
  double offset_proximal_mm = 0;
  double depth_mm = 0;         // of the guide point beyond the entry along the plan; negative before it
  double remaining_mm = 0;     // planned length - depth
  double sigma_offset_mm = 0;  // predicted, one sigma
  double sigma_angle_deg = 0;
  [[nodiscard]] bool is_valid() const { return state == GuidanceState::Valid; }
};

// Allocates nothing.
[[nodiscard]] GuidanceNumbers compute_guidance(const GuidanceInput& input);

}  // namespace arthronaut::guidance
