// What a server has to tell.
#pragma once

#include <memory>

#include "navigation/operation/operation_state.h"

namespace arthronaut::test {

inline geometry::RigidTransform made_pose(double seed) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, seed, -0.5).normalized();
  return {Eigen::Quaterniond(Eigen::AngleAxisd(0.3 + 0.1 * seed, axis)), {10 * seed, -20, 35 + seed}};
}

// Probe and guide are seen, the drill is not; a registration stands.
inline operation::OperationState made_state() {
  operation::OperationState state;
  auto source = std::make_shared<operation::SourceSetup>();
  tools::Tool probe, guide, drill;
  probe.name = "probe";
  probe.marker_id = 2;
  guide.name = "femoral guide";
  guide.marker_id = 3;
  drill.name = "drill";
  drill.marker_id = 9;
  probe.tip_mm = Eigen::Vector3d(0, -38, -6);
  drill.kind = tools::ToolKind::Drill;
  source->pipeline.tools.tools = {probe, guide, drill};
  state.source = source;
  state.has_source = true;
  state.frame_count = 1;
  state.frame.camera_from_world = {made_pose(1), 0, true};
  state.frame.tools = {
      {2, {made_pose(2), 0, true}}, {3, {made_pose(3), 0, true}}, {9, {made_pose(4), 0, false}}};
  auto registered = std::make_shared<operation::RegistrationState>();
  auto found = std::make_shared<registration::RegistrationSummary>();
  found->marker_from_bone = made_pose(5);
  registered->in_force.registration = found;
  registered->in_force.standing = operation::Standing::Stands;
  state.registration = registered;
  state.frame.guidance.state = guidance::GuidanceState::GuideLost;
  return state;
}

}  // namespace arthronaut::test
