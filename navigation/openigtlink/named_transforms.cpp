#include "navigation/openigtlink/named_transforms.h"

#include "navigation/openigtlink/ras_from_lps.h"

namespace arthronaut::openigtlink {

namespace {

using geometry::RigidTransform;

const pipeline::ToolPose* pose_of(const operation::OperationState& state, int marker_id) {
  for (const pipeline::ToolPose& tool : state.frame.tools)
    if (tool.marker_id == marker_id && tool.world_from_tool.is_valid) return &tool;
  return nullptr;
}

bool is_drill(const tools::Tool& tool) { return tool.kind == tools::ToolKind::Drill; }

// Which of several drills the depth is of that the screen says: ", depth of tibial drill (Drill2_World)".
std::string drill_words(const operation::OperationState& state) {
  const auto& told = state.frame.guidance.drill;
  if (!told || !told->marker_id || !has_second_drill(state)) return "";
  int drill = 0;
  for (const tools::Tool& tool : state.source->pipeline.tools.tools) {
    drill += is_drill(tool) ? 1 : 0;
    if (!is_drill(tool) || tool.marker_id != *told->marker_id) continue;
    const std::string name = drill == 1 ? " (Drill_World)" : drill == 2 ? " (Drill2_World)" : "";
    return ", depth of " + tool.name + name;
  }
  return "";
}

}  // namespace

bool has_second_drill(const operation::OperationState& state) {
  return state.source != nullptr && state.source->pipeline.tools.has_several_drills();
}

std::vector<NamedTransform> named_transforms(const operation::OperationState& state) {
  std::vector<NamedTransform> named;
  const auto add = [&](std::string name, const RigidTransform& target_from_source) {
    named.push_back({std::move(name), ras_from_lps(target_from_source)});
  };
  if (!state.has_source || state.frame_count == 0 || state.source == nullptr) return named;
  const pipeline::PipelineOptions& setup = state.source->pipeline;
  if (state.frame.camera_from_world.is_valid) {
    add(state.bone == bones::BoneKind::Femur ? "WorldFemur" : "WorldTibia",
        state.frame.camera_from_world.target_from_source);
  }
  int drill = 0;  // two under one name would be one that jumps from hand to hand
  for (const tools::Tool& tool : setup.tools.tools) {
    drill += is_drill(tool) ? 1 : 0;
    const pipeline::ToolPose* const seen = pose_of(state, tool.marker_id);
    if (seen == nullptr) continue;
    const RigidTransform& world_from_tool = seen->world_from_tool.target_from_source;
    if (tool.name == setup.probe_name && tool.tip_mm)
      add("ProbeTip_World", {world_from_tool.rotation, world_from_tool * *tool.tip_mm});
    if (tool.name == setup.guide_name) add("Guide_World", world_from_tool);
    if (is_drill(tool) && drill == 1) add("Drill_World", world_from_tool);
    if (is_drill(tool) && drill == 2) add(std::string(kSecondDrill), world_from_tool);
  }
  const operation::RegistrationInForce& in_force = state.registration->in_force;
  if (in_force.standing == operation::Standing::Stands && in_force.registration != nullptr &&
      state.time_out != operation::TimeOut::Due)
    add("Bone_World", in_force.registration->marker_from_bone);
  return named;
}

std::string why_without(const operation::OperationState& state, std::string_view name) {
  if (!state.has_source) return "no source";
  if (name != "Bone_World") return "not seen";
  if (state.time_out == operation::TimeOut::Due) return "the time-out is due";
  return "registration: " + std::string(operation::to_text(state.registration->in_force.standing));
}

std::vector<NamedPoint> plan_points(const operation::OperationState& state) {
  if (!state.plan) return {};
  const tunnels::Tunnel& tunnel = state.plan->tunnel;
  const Eigen::Vector3d ras_from_lps(-1, -1, 1);
  const Eigen::Vector3d end_mm = tunnel.entry_mm + state.plan->length_mm * tunnel.direction.normalized();
  return {{"entry", tunnel.entry_mm.cwiseProduct(ras_from_lps), tunnel.diameter_mm / 2},
          {"end", end_mm.cwiseProduct(ras_from_lps), tunnel.diameter_mm / 2}};
}

Status status_of(const operation::OperationState& state) {
  if (!state.has_source) return {false, "no source"};
  if (state.frame_count == 0) return {false, "no picture yet"};
  const guidance::GuidanceNumbers& guidance = state.frame.guidance;
  // A client does not see the frame about our window that says it.
  const bool is_simulated = state.source != nullptr && state.source->kind == sources::SourceKind::Simulation;
  const std::string drill = drill_words(state);
  if (guidance.is_valid()) return {true, (is_simulated ? "OK, simulation" : "OK") + drill};
  // No guide that is brought would help.
  const bool is_slow = state.timing == operation::PictureTiming::Slow &&
                       state.registration->in_force.standing == operation::Standing::Stands;
  const auto why = is_slow ? guidance::GuidanceState::PicturesSlow : guidance.state;
  return {false, std::string(guidance::to_text(why)) + drill};
}

}  // namespace arthronaut::openigtlink
