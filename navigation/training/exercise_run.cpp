#include "navigation/training/exercise_run.h"

#include <cmath>
#include <utility>

#include "navigation/camera/medium.h"
#include "navigation/training/board_run.h"
#include "planning/bones/mesh_hash.h"
#include "planning/geometry/error.h"
#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::training {

namespace {

using bones::BoneKind;
using simulator::HandTruth;
using simulator::Press;

constexpr int kFramesPerSecond = 30;

const bones::Bone& bone_of(const ExerciseSetup& setup) {
  return setup.exercise.bone == BoneKind::Femur ? setup.knee.femur : setup.knee.tibia;
}

double length_of(const ExerciseSetup& setup) {
  if (setup.plan_length_mm > 0) return setup.plan_length_mm;
  return tunnels::length_along(setup.plan, geometry::Surface(bone_of(setup).mesh)).value_or(0);
}

simulator::SimulationOptions simulation_of(const ExerciseSetup& setup) {
  simulator::SimulationOptions options;
  options.knee = setup.knee;
  options.camera = simulator::standard_camera();
  options.tools = tools::standard_tools();
  options.bone = setup.exercise.bone;
  options.plan = setup.plan;
  options.refractive_index = camera::kSalineIndex;
  options.seed = setup.seed;
  options.frames_per_second = kFramesPerSecond;
  options.surroundings = surroundings_of(setup.exercise, setup.level);
  return options;
}

const tools::Tool& probe_of(const tools::ToolSet& tools) {
  const tools::Tool* const probe = tools.find_tool("probe");
  if (probe == nullptr || !probe->tip_mm) throw InvalidInput("training: the tools hold no probe with a tip");
  return *probe;
}

}  // namespace

ExerciseWatch::ExerciseWatch(const ExerciseSetup& setup)
    : examiner_(setup.exercise, setup.plan, length_of(setup), *probe_of(tools::standard_tools()).tip_mm) {}

void ExerciseWatch::add(const operation::OperationState& state) {
  const auto truth = log_->at(state.frame.frame_index);
  const std::lock_guard lock(mutex_);
  if (source_ == nullptr) source_ = state.source;
  if (!truth) return;
  examiner_.add(state, *truth);
}

void ExerciseWatch::finish() {
  const std::lock_guard lock(mutex_);
  examiner_.finish();
}

bool ExerciseWatch::is_of(const operation::OperationState& state) const {
  const std::lock_guard lock(mutex_);
  return state.source != nullptr && state.source == source_ &&
         source_->kind == sources::SourceKind::Simulation;
}

bool ExerciseWatch::has_begun() const {
  const std::lock_guard lock(mutex_);
  return source_ != nullptr;
}

ExerciseFacts ExerciseWatch::facts() const {
  const std::lock_guard lock(mutex_);
  return examiner_.facts();
}

ExerciseSetup standard_setup(const Exercise& exercise, Level level, std::uint64_t seed) {
  ExerciseSetup setup{.exercise = exercise, .level = level, .knee = {}, .plan = {}, .seed = seed};
  if (exercise.goal == Goal::Calibrate) return setup;  // the board alone needs no knee
  setup.knee = phantom::make_phantom_knee({.seed = seed});
  setup.plan = exercise.bone == BoneKind::Femur ? setup.knee.femoral_tunnel : setup.knee.tibial_tunnel;
  return setup;
}

bool begins_registered(const Exercise& exercise) { return exercise.goal == Goal::Aim; }

theatre::TheatreSource exercise_source(const ExerciseSetup& setup, const simulator::Hand& hand,
                                       const std::shared_ptr<ExerciseWatch>& watch, bool in_real_time) {
  theatre::TheatreSource source;
  operation::SourceSetup& of = source.setup;
  of.kind = sources::SourceKind::Simulation;
  of.title = "Training: " + std::string(setup.exercise.title) + ", " + std::string(to_text(setup.level));
  of.calibration = of.calibration_in_short = "simulated scope and tools";
  of.pipeline.bone = setup.exercise.bone;
  of.pipeline.side = setup.knee.side;
  of.pipeline.guide_name = tools::standard_guide_name(setup.exercise.bone);
  of.pipeline.tools = tools::standard_tools();
  of.pipeline.calibration = simulator::with_fewer_pixels(simulator::standard_camera(), kPictureShare);
  camera::CalibrationRecord built_in;
  built_in.scope_name = camera::kSimulatedScope;
  built_in.provenance = {provenance::Origin::Simulated, ""};
  of.pipeline.calibrated = std::make_shared<const camera::CalibrationRecord>(std::move(built_in));
  of.pipeline.refractive_index = camera::kSalineIndex;
  const auto& landmarks =
      setup.exercise.bone == BoneKind::Femur ? setup.knee.femur_landmarks : setup.knee.tibia_landmarks;
  of.pipeline.axes =
      landmarks::anatomical_axes(setup.exercise.bone, setup.knee.side, landmarks, bone_of(setup).mesh);
  of.draws = setup.exercise.goal == Goal::Register || setup.exercise.goal == Goal::Drill;
  simulator::HandOptions options;
  options.hand = hand;
  options.held = setup.exercise.goal == Goal::Aim ? simulator::Held::Guide : simulator::Held::Probe;
  options.starts_at_dimple = setup.exercise.goal == Goal::Pivot;
  options.faults = faults_of(setup.exercise, setup.level);
  options.picture_share = kPictureShare;
  options.in_real_time = in_real_time;
  options.log = watch->log();
  source.watch = [watch](const operation::OperationState& state) { watch->add(state); };
  source.open = [simulation = simulation_of(setup), options]() -> std::unique_ptr<sources::FrameSource> {
    return std::make_unique<simulator::HandOperation>(simulation, options);
  };
  return source;
}

registration::RegistrationSummary known_registration(const HandTruth& truth) {
  // As well known as a good registration is; exact in truth.
  constexpr double kSigma_mm = 0.3, kSigma_rad = 0.004;
  registration::RegistrationSummary known;
  known.has_pose = known.reliable = true;
  known.reasons.clear();
  known.marker_from_bone = truth.marker_from_bone;
  known.covariance.diagonal().head<3>().setConstant(kSigma_mm * kSigma_mm / 3);
  known.covariance.diagonal().tail<3>().setConstant(kSigma_rad * kSigma_rad);
  known.predicted_tre_mm = kSigma_mm;
  known.inlier_fraction = 1;
  known.runner_up_ratio = 10;
  return known;
}

std::vector<operation::Command> commands_of(Press press, double depth_mm) {
  switch (press) {
    case Press::Touch:
      return {operation::TakeTouch{}};
    case Press::ControlPoint:
      return {operation::TouchControlPoint{}};
    case Press::Register:
      return {operation::RegisterStrokes{}};
    case Press::Draw:
      return {operation::Draw{true}};
    case Press::StopDrawing:
      return {operation::Draw{false}};
    case Press::MarkerAnew:
      return {operation::MarkerPlacedAnew{}};
    case Press::Drilled:
      return {operation::ReadDepthStop{std::round(depth_mm)}, operation::TunnelDrilled{}};
    case Press::None:
    case Press::Finish:
    case Press::Picture:
    case Press::DropPicture:
      return {};
  }
  return {};
}

namespace {

ExerciseOutcome scored(const ExerciseSetup& setup, const ExerciseFacts& facts,
                       std::vector<HandTruth> frames) {
  ExerciseOutcome outcome{facts, score_of(setup.exercise, setup.level, facts), std::move(frames)};
  outcome.score.seed = setup.seed;
  return outcome;
}

ExerciseOutcome run_calibrating(const ExerciseSetup& setup, const simulator::Hand& hand,
                                const std::function<void(long frames)>& on_frame) {
  BoardRun run(setup, hand, false);
  while (run.step())
    if (on_frame) on_frame(run.facts().frames);
  return scored(setup, run.facts(), run.frames());
}

}  // namespace

ExerciseOutcome run_exercise(const ExerciseSetup& setup, const simulator::Hand& hand,
                             const theatre::RecordOptions& record,
                             const std::function<void(long frames)>& on_frame) {
  if (setup.exercise.goal == Goal::Calibrate) {
    if (!record.folder.empty())
      throw InvalidInput("training: calibrating is no operation and leaves no session");
    return run_calibrating(setup, hand, on_frame);
  }
  const auto watch = std::make_shared<ExerciseWatch>(setup);
  const theatre::TheatreSource source = exercise_source(setup, hand, watch, false);
  const std::shared_ptr<sources::FrameSource> opened = source.open();
  const auto surface = std::make_shared<const geometry::Surface>(bone_of(setup).mesh);
  theatre::NavigateOptions options;
  options.source = source.setup;
  options.operation.bone = setup.exercise.bone;
  options.operation.mesh_sha256 = bones::mesh_sha256(bone_of(setup).mesh);
  options.operation.surface = surface;
  options.operation.seed = setup.seed;
  options.operation.plan =
      operation::PlannedTunnel{setup.plan, tunnels::length_along(setup.plan, *surface).value_or(0)};
  if (source.setup.draws)
    options.bone = std::make_shared<const registration::SurfaceIndex>(bone_of(setup).mesh);
  theatre::NavigationObserver observer;
  observer.on_frame = [&](const camera::FramePtr& picture, const operation::OperationStatePtr& state) {
    watch->add(*state);
    if (on_frame) on_frame(static_cast<long>(picture->index) + 1);
  };
  bool is_first = true;
  observer.pedal = [&](const operation::OperationState& state) -> std::vector<operation::Command> {
    const auto truth = watch->log()->at(state.frame.frame_index);
    if (!truth) return {};
    std::vector<operation::Command> commands = commands_of(truth->input.press, truth->hand.drilled_depth_mm);
    if (truth->input.press == Press::Finish) watch->finish();
    if (!std::exchange(is_first, false)) return commands;
    if (!source.setup.draws) commands.emplace_back(operation::Draw{false});
    if (begins_registered(setup.exercise)) {
      commands.emplace_back(operation::GiveRegistration{
          known_registration(*truth), operation::provenance_of(options.operation, options.source), false});
      commands.emplace_back(operation::SkipVerification{});
    }
    return commands;
  };
  const theatre::NavigationSummary summary = theatre::navigate_source(opened, options, record, observer);
  if (!summary.record_trouble.empty()) throw IoError(summary.record_trouble);
  return scored(setup, watch->facts(), watch->log()->all());
}

}  // namespace arthronaut::training
