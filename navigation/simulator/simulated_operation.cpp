#include "navigation/simulator/simulated_operation.h"

#include <algorithm>
#include <cmath>

#include "navigation/simulator/instruments.h"
#include "navigation/simulator/random.h"
#include "navigation/simulator/renderer.h"
#include "navigation/simulator/script.h"
#include "planning/geometry/error.h"

namespace arthronaut::simulator {

namespace {

const geometry::TriangleMesh& bone_mesh(const SimulationOptions& options) {
  return options.bone == bones::BoneKind::Femur ? options.knee.femur.mesh : options.knee.tibia.mesh;
}

// Where the scripted surgeon truly drills: the plan, missed by as much as the options say, in a direction
// drawn by seed.
tunnels::Tunnel aimed_tunnel(const SimulationOptions& options, const geometry::Surface& bone) {
  Random random(options.seed + 31);
  const Eigen::Vector3d axis = options.plan.direction.normalized();
  const Eigen::Vector3d side = axis.unitOrthogonal(), up = axis.cross(side);
  const double where = random.between(0, 2 * geometry::kPi), hinge = random.between(0, 2 * geometry::kPi);
  tunnels::Tunnel aim = options.plan;
  aim.direction = Eigen::AngleAxisd(geometry::rad_from_deg(options.drill_error_deg),
                                    Eigen::Vector3d(std::cos(hinge) * side + std::sin(hinge) * up)) *
                  axis;
  aim.entry_mm += options.drill_error_mm * (std::cos(where) * side + std::sin(where) * up);
  const auto measured = tunnels::measure(aim, bone);
  if (!measured.enters_bone) throw InvalidInput("simulator: the plan misses the bone");
  aim.entry_mm = measured.entry_on_surface_mm;
  return aim;
}

}  // namespace

struct SimulatedOperation::State {
  SimulationOptions options;
  Phase phase;
  geometry::Surface bone;
  Staging staging;
  tunnels::Tunnel aim;
  Script script;
  Surroundings surroundings;
  BoneView bone_view;
  Renderer renderer;
  sources::SourceInfo info;
  FrameTruth truth;
  float exposure = 300;
  std::int64_t next_index = 0;

  State(const SimulationOptions& o, Phase p)
      : options(o),
        phase(p),
        bone(bone_mesh(o)),
        bone_view(bone_mesh(o), o.seed),
        renderer(&bone_view, SensorOptions{}) {
    if (options.frames_per_second < 1 || options.frame_count < 0 || options.rest_count < 0) {
      throw InvalidInput(
          "simulator: frames_per_second must be above 0, frame_count and rest_count not below 0");
    }
    if (!options.draws && options.rest_count == 0)
      throw InvalidInput("simulator: without strokes rest_count must be above 0");
    // The board alone needs no place in the knee.
    if (phase != Phase::Calibrate) {
      staging = stage_operation(options, bone);
      aim = aimed_tunnel(options, bone);
    }
    script = write_script();
    if (options.surroundings.any() && phase != Phase::Calibrate)
      surroundings = Surroundings(options.surroundings, bone,
                                  {.worked_at_mm = options.plan.entry_mm,
                                   .kept_free_mm = staging.bone_from_world_marker.translation_mm,
                                   .bone_from_camera = script.front().bone_from_camera},
                                  options.seed);
    exposure = fitting_exposure();
    info.name = "simulated arthroscope";
    info.kind = sources::SourceKind::Simulation;
    info.image_size_px = options.camera.image_size_px;
    info.frames_per_second = options.frames_per_second;
    info.frame_count =
        options.frame_count > 0 ? options.frame_count : static_cast<std::int64_t>(script.size());
  }

  Script write_script() const {
    switch (phase) {
      case Phase::Calibrate:
        return calibrate_script(options);
      case Phase::Pivot:
        return pivot_script(options, staging);
      case Phase::Scratch:
        return scratch_script(options, staging);
      case Phase::Drill:
        return drill_script(options, staging, aim, tunnels::measure(aim, bone).length_mm);
    }
    throw InvalidInput("simulator: no such phase");
  }

  const tools::Tool& tool() const {
    return phase == Phase::Drill ? guide_of(options) : probe_of(options.tools);
  }

  // A white surface at the nearest marker stays below saturation all through the phase, as a camera's own
  // control would have it; fixed for the phase, so that nothing flickers.
  float fitting_exposure() const {
    constexpr double kBrightest = 0.85;
    double nearest_mm = 1e9;
    for (const Moment& moment : script) {
      if (moment.camera_from_board) {
        nearest_mm = std::min(nearest_mm, 0.8 * moment.camera_from_board->translation_mm.norm());
        continue;
      }
      const auto camera_from_bone = moment.bone_from_camera.inverse();
      const auto& tool_pose = moment.bone_from_probe ? moment.bone_from_probe : moment.bone_from_guide;
      nearest_mm = std::min(nearest_mm, (camera_from_bone * tool_pose->translation_mm).norm());
    }
    return static_cast<float>(kBrightest * nearest_mm * nearest_mm);
  }

  const Moment& moment_of(std::int64_t index) const {
    const auto last = static_cast<std::int64_t>(script.size()) - 1;
    if (options.frame_count <= 1) return script[static_cast<std::size_t>(std::min(index, last))];
    const double share = static_cast<double>(index) / (options.frame_count - 1);
    return script[static_cast<std::size_t>(std::lround(share * static_cast<double>(last)))];
  }

  template <typename Body>
  void add_truth(const Body& body, const geometry::RigidTransform& camera_from_body) {
    for (const tools::BodyMarker& marker : tools::markers_of(body))
      truth.markers.push_back({marker.marker_id, camera_from_body * marker.body_from_marker});
  }

  camera::FramePtr render(std::int64_t index) {
    const Moment& moment = moment_of(index);
    truth = {.frame_index = index,
             .mark_angle_deg = std::fmod(moment.mark_angle_deg + 720, 360.0),
             .markers = {},
             .camera_from_bone = moment.bone_from_camera.inverse(),
             .tip_touches_bone = moment.tip_touches_bone,
             .drilled_depth_mm = moment.drilled_depth_mm};
    Scene scene;
    scene.exposure = exposure;
    if (moment.camera_from_board) {
      scene.solids.push_back(make_checkerboard(*moment.camera_from_board, options.square_mm));
    } else {
      scene.has_bone = true;
      scene.camera_from_bone = truth.camera_from_bone;
      const auto& world = world_marker_of(options);
      const geometry::RigidTransform camera_from_world =
          truth.camera_from_bone * staging.bone_from_world_marker;
      add_truth(world, camera_from_world);
      add_world_marker(world, camera_from_world, scene.solids);
      const auto& tool_pose = moment.bone_from_probe ? moment.bone_from_probe : moment.bone_from_guide;
      const geometry::RigidTransform camera_from_tool = truth.camera_from_bone * *tool_pose;
      add_truth(tool(), camera_from_tool);
      add_tool(tool(), camera_from_tool, scene.solids);
      surroundings.add(static_cast<double>(index) / options.frames_per_second, truth.camera_from_bone,
                       scene.solids);
    }
    const camera::CameraModel model(options.camera, options.camera.lens_angle_rad(truth.mark_angle_deg),
                                    phase == Phase::Calibrate ? 1.0 : options.refractive_index);
    const auto frame = std::make_shared<camera::Frame>();
    renderer.render(scene, model, truth.mark_angle_deg,
                    options.seed * 1'000'003 + static_cast<std::uint64_t>(index), *frame);
    frame->index = index;
    frame->timestamp_ns = index * 1'000'000'000 / options.frames_per_second;
    return frame;
  }
};

SimulatedOperation::SimulatedOperation(const SimulationOptions& options, Phase phase)
    : state_(std::make_unique<State>(options, phase)) {}
SimulatedOperation::~SimulatedOperation() = default;

const sources::SourceInfo& SimulatedOperation::info() const { return state_->info; }

camera::FramePtr SimulatedOperation::next() {
  if (state_->next_index >= state_->info.frame_count) return nullptr;
  return state_->render(state_->next_index++);
}

const FrameTruth& SimulatedOperation::truth() const { return state_->truth; }

geometry::RigidTransform SimulatedOperation::marker_from_bone() const {
  return state_->staging.bone_from_world_marker.inverse();
}

tunnels::Tunnel SimulatedOperation::drilled_tunnel() const { return state_->aim; }

}  // namespace arthronaut::simulator
