#include "app/navigate/navigate_setup.h"

#include "app/case/case_calibration.h"
#include "navigation/camera/medium.h"
#include "navigation/simulator/simulated_operation.h"
#include "planning/geometry/error.h"

namespace arthronaut::navigate {

namespace {

constexpr int kPlacesToTouch = 4;  // three verify, one is the control point

std::string guide_name_of(bones::BoneKind bone) {
  return bone == bones::BoneKind::Femur ? "femoral guide" : "tibial guide";
}

OperationSetup setup_of(const open_case::PlanModel& model, bones::BoneKind bone) {
  OperationSetup setup;
  setup.pipeline.bone = bone;
  setup.pipeline.side = model.knee().side;
  setup.pipeline.guide_name = guide_name_of(bone);
  setup.plan = model.tunnel(bone);
  setup.planned_length_mm = setup.plan ? model.drawn_length_mm(bone) : 0;
  setup.surface = model.shared_surface(bone);
  setup.drawn_bone = model.drawn_mesh(bone);
  return setup;
}

const landmarks::Landmarks& landmarks_of(const cases::Case& knee, bones::BoneKind bone) {
  static const landmarks::Landmarks kNone;
  const auto found = knee.landmarks.find(bone);
  return found == knee.landmarks.end() ? kNone : found->second;
}

phantom::PhantomKnee phantom_of(const cases::Case& knee) {
  phantom::PhantomKnee phantom;
  phantom.side = knee.side;
  if (knee.bones.contains(bones::BoneKind::Femur)) phantom.femur = knee.bones.at(bones::BoneKind::Femur);
  if (knee.bones.contains(bones::BoneKind::Tibia)) phantom.tibia = knee.bones.at(bones::BoneKind::Tibia);
  phantom.femur_landmarks = landmarks_of(knee, bones::BoneKind::Femur);
  phantom.tibia_landmarks = landmarks_of(knee, bones::BoneKind::Tibia);
  const auto& tunnels = knee.plan.tunnels;
  if (tunnels.contains(bones::BoneKind::Femur)) phantom.femoral_tunnel = tunnels.at(bones::BoneKind::Femur);
  if (tunnels.contains(bones::BoneKind::Tibia)) phantom.tibial_tunnel = tunnels.at(bones::BoneKind::Tibia);
  return phantom;
}

}  // namespace

std::string missing_for_simulation(const open_case::PlanModel& model, bones::BoneKind bone) {
  if (!model.has_bone(bone)) return "the case has no " + std::string(bones::to_text(bone));
  if (!model.has_bone(bones::BoneKind::Femur) || !model.has_bone(bones::BoneKind::Tibia))
    return "the case has only one bone";
  if (!model.tunnel(bone)) return "there is no planned tunnel to aim at";
  const landmarks::Landmarks& known = landmarks_of(model.knee(), bone);
  return known.contains("native_footprint") ? "" : "the landmarks of the bone are not known";
}

OperationSetup simulated_setup(const open_case::PlanModel& model, bones::BoneKind bone,
                               const std::filesystem::path& case_folder, SimulatedPart part) {
  OperationSetup setup = setup_of(model, bone);
  setup.title = part == SimulatedPart::Scratch ? "Simulated operation: probe" : "Simulated operation: drill";
  setup.pipeline.calibration = open_case::camera_of(true, case_folder);
  setup.pipeline.tools = open_case::tools_of(true, case_folder);
  setup.calibration = open_case::calibration_in_words(true, case_folder);
  setup.pipeline.refractive_index = camera::kSalineIndex;
  setup.digitises = part == SimulatedPart::Scratch;
  simulator::SimulationOptions simulation;
  simulation.knee = phantom_of(model.knee());
  simulation.camera = simulator::standard_camera();
  simulation.tools = tools::standard_tools();
  simulation.rest_count = kPlacesToTouch;
  simulation.bone = bone;
  simulation.plan = *setup.plan;
  simulation.refractive_index = setup.pipeline.refractive_index;
  setup.truth = std::make_shared<std::optional<tunnels::Tunnel>>();
  setup.open_source = [simulation, part, truth = setup.truth]() -> std::unique_ptr<sources::FrameSource> {
    if (part == SimulatedPart::Scratch)
      return std::make_unique<simulator::SimulatedOperation>(simulation, simulator::Phase::Scratch);
    auto operation = std::make_unique<simulator::SimulatedOperation>(simulation, simulator::Phase::Drill);
    *truth = operation->drilled_tunnel();
    return operation;
  };
  return setup;
}

namespace {

// With the case's own camera.json and tools.json.
OperationSetup real_setup(const open_case::PlanModel& model, bones::BoneKind bone,
                          const std::filesystem::path& case_folder, double refractive_index) {
  if (!model.has_bone(bone)) throw InvalidInput("the case has no " + std::string(bones::to_text(bone)));
  OperationSetup setup = setup_of(model, bone);
  setup.pipeline.calibration = camera::read_camera_file(cases::camera_file(case_folder)).calibration;
  setup.pipeline.tools = tools::read_tools_file(cases::tools_file(case_folder));
  setup.calibration = open_case::calibration_in_words(false, case_folder);
  setup.pipeline.refractive_index = refractive_index;
  if (setup.pipeline.tools.find_world_marker(bone) == nullptr)
    throw InvalidInput("tools.json declares no world marker for the " + std::string(bones::to_text(bone)));
  return setup;
}

}  // namespace

OperationSetup video_setup(const open_case::PlanModel& model, bones::BoneKind bone,
                           const std::filesystem::path& case_folder, const std::filesystem::path& video,
                           double refractive_index) {
  OperationSetup setup = real_setup(model, bone, case_folder, refractive_index);
  setup.title = video.filename().string();
  setup.open_source = [video] { return sources::open_video(video); };
  return setup;
}

OperationSetup camera_setup(const open_case::PlanModel& model, bones::BoneKind bone,
                            const std::filesystem::path& case_folder, const sources::ConnectedCamera& camera,
                            const sources::DeviceTurns& turns, double refractive_index) {
  OperationSetup setup = real_setup(model, bone, case_folder, refractive_index);
  setup.title = camera.name;
  setup.open_source = [turns, index = camera.index] { return turns.open(index); };
  return setup;
}

}  // namespace arthronaut::navigate
