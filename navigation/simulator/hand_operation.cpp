#include "navigation/simulator/hand_operation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "navigation/simulator/frame_pace.h"
#include "navigation/simulator/holding.h"
#include "navigation/simulator/instruments.h"
#include "navigation/simulator/random.h"
#include "navigation/simulator/renderer.h"
#include "navigation/simulator/staging.h"
#include "navigation/sources/exercise_source.h"
#include "planning/geometry/error.h"

namespace arthronaut::simulator {

namespace {

using Eigen::Vector3d;
using geometry::RigidTransform;

constexpr double kLifted_mm = 1.5;         // of the probe's tip off the bone at the beginning
constexpr double kAtDimple_mm = 1;         // where it is to pivot: further off, its marker may leave the view
constexpr double kClearOfBones_rad = 0.5;  // of the bone's marker, as the lens sees it
constexpr double kGuideBack_mm = 7;        // of the guide's point from the planned entry, at the beginning
constexpr double kGuideAside_mm = 3, kGuideAslant_deg = 11;
constexpr double kBumpDegPerMm = 1.5;

const geometry::TriangleMesh& mesh_of(const SimulationOptions& options) {
  return options.bone == bones::BoneKind::Femur ? options.knee.femur.mesh : options.knee.tibia.mesh;
}

Vector3d handle_of(const ProbePose& pose) {
  return (pose.bone_from_marker.translation_mm - pose.tip_mm).normalized();
}

// Where the hand begins: of all stops the one at which, lifted towards the lens, its marker is nearest to
// the middle of the view, and clear of the bone's.
ProbePose begin_in_view(const std::vector<std::vector<ProbePose>>& stops, const RigidTransform& view,
                        const Vector3d& world_marker_mm, double lift_mm) {
  const Vector3d eye = view.translation_mm, ahead = view.rotate(Vector3d::UnitZ());
  ProbePose best;
  double best_rad = std::numeric_limits<double>::infinity();
  for (const auto& row : stops) {
    for (ProbePose pose : row) {
      const Vector3d lift = lift_mm * (eye - pose.tip_mm).normalized();
      pose.tip_mm += lift;
      pose.bone_from_marker.translation_mm += lift;
      const Vector3d marker = pose.bone_from_marker.translation_mm - eye;
      const double apart_rad = geometry::angle_between_rad(marker, world_marker_mm - eye);
      const double rad =
          geometry::angle_between_rad(marker, ahead) + 2 * std::max(0.0, kClearOfBones_rad - apart_rad);
      if (rad >= best_rad) continue;
      best_rad = rad;
      best = pose;
    }
  }
  return best;
}

HandScene scene_of(const SimulationOptions& options, const Staging& staging, const geometry::Surface& bone,
                   const HandOptions& hand) {
  HandScene scene;
  scene.plan = options.plan;
  scene.plan.direction.normalize();
  scene.plan_length_mm = tunnels::length_along(scene.plan, bone).value_or(0);
  for (const auto& stroke : staging.strokes) {
    auto& tips = scene.strokes.emplace_back();
    auto& handles = scene.handles.emplace_back();
    for (const ProbePose& pose : stroke) {
      tips.push_back(pose.tip_mm);
      handles.push_back(handle_of(pose));
    }
  }
  HandStart& start = scene.start;
  start.held = hand.held;
  if (!staging.pivot.empty()) {
    scene.dimple_mm = staging.pivot.front().tip_mm;
    scene.dimple_handle.setZero();
    for (const ProbePose& pose : staging.pivot) scene.dimple_handle += handle_of(pose);
    scene.dimple_handle.normalize();
  } else if (hand.starts_at_dimple) {
    throw InvalidInput("simulator: the probe pivots on the femur, not on the tibia");
  }
  start.bone_from_camera_probe =
      hand.starts_at_dimple ? staging.bone_from_camera_pivot : staging.bone_from_camera_scratch;
  start.bone_from_camera_guide = staging.bone_from_camera_drill;
  start.mark_angle_deg = options.camera.reference_mark_angle_deg;
  const ProbePose begin = begin_in_view(
      hand.starts_at_dimple ? std::vector<std::vector<ProbePose>>{staging.pivot} : staging.strokes,
      start.bone_from_camera_probe, staging.bone_from_world_marker.translation_mm,
      hand.starts_at_dimple ? kAtDimple_mm : kLifted_mm);
  start.probe_tip_mm = begin.tip_mm;
  start.probe_handle = handle_of(begin);
  Random random(options.seed + 53);
  const Vector3d axis = scene.plan.direction;
  const Vector3d side = Eigen::AngleAxisd(random.between(0, 2 * geometry::kPi), axis) * axis.unitOrthogonal();
  start.guide_direction =
      Eigen::AngleAxisd(geometry::rad_from_deg(kGuideAslant_deg), axis.cross(side)) * axis;
  start.guide_point_mm = scene.plan.entry_mm - kGuideBack_mm * axis + kGuideAside_mm * side;
  return scene;
}

}  // namespace

void HandLog::add(const HandTruth& truth) {
  const std::lock_guard lock(mutex_);
  frames_.push_back(truth);
}
std::optional<HandTruth> HandLog::at(std::int64_t frame) const {
  const std::lock_guard lock(mutex_);
  if (frame < 0 || frame >= std::ssize(frames_)) return std::nullopt;
  return frames_[static_cast<std::size_t>(frame)];
}
std::vector<HandTruth> HandLog::all() const {
  const std::lock_guard lock(mutex_);
  return frames_;
}
std::optional<HandTruth> HandLog::newest() const {
  const std::lock_guard lock(mutex_);
  return frames_.empty() ? std::nullopt : std::optional(frames_.back());
}

camera::Calibration with_fewer_pixels(const camera::Calibration& calibration, double share) {
  if (!(share >= 0.2 && share <= 1)) throw InvalidInput("simulator: picture_share must lie in [0.2, 1]");
  camera::Calibration small = calibration;
  const auto scaled = [share](const Eigen::Vector2d& px) -> Eigen::Vector2d {
    return share * (px + Eigen::Vector2d(0.5, 0.5)) - Eigen::Vector2d(0.5, 0.5);  // pixels count from centres
  };
  small.image_size_px = (share * calibration.image_size_px.cast<double>()).array().round().cast<int>();
  small.focal_px *= share;
  small.principal_point_px = scaled(calibration.principal_point_px);
  small.rotation_center_px = scaled(calibration.rotation_center_px);
  small.boundary.center_px = scaled(calibration.boundary.center_px);
  small.boundary.radius_px *= share;
  small.covariance.reset();
  return small;
}

struct HandOperation::State {
  SimulationOptions options;
  HandOptions hand;
  camera::Calibration camera;  // with fewer pixels
  geometry::Surface bone;
  Staging staging;
  HandScene scene;
  HandControl control;
  RigidTransform bone_from_world;                       // the marker, where it is now
  Surroundings probe_surroundings, guide_surroundings;  // of either tool's view
  BoneView bone_view;
  Renderer renderer;
  sources::SourceInfo info;
  RigidTransform bone_from_probe, bone_from_guide;  // as they could be held last
  FramePace pace;
  FaultPlay faults;
  std::int64_t next_index = 0;
  double time_s = 0, slid_mm = 0;

  State(const SimulationOptions& o, HandOptions h)
      : options(o),
        hand(std::move(h)),
        camera(with_fewer_pixels(o.camera, hand.picture_share)),
        bone(mesh_of(o)),
        staging(stage_operation(o, bone)),
        scene(scene_of(o, staging, bone, hand)),
        control(scene.start, bone, hand.limits),
        bone_from_world(staging.bone_from_world_marker),
        probe_surroundings(surroundings_seen_from(scene.start.bone_from_camera_probe)),
        guide_surroundings(surroundings_seen_from(scene.start.bone_from_camera_guide)),
        bone_view(mesh_of(o), o.seed),
        renderer(&bone_view, SensorOptions{.blur_sigma_px = std::max(0.5, hand.picture_share)}),
        bone_from_probe(staging.strokes.front().front().bone_from_marker),
        pace(o.frames_per_second, hand.in_real_time),
        faults(hand.faults, o.seed) {
    if (options.frames_per_second < 1) throw InvalidInput("simulator: frames_per_second must be above 0");
    if (!hand.hand) throw InvalidInput("simulator: there is no hand");
    bone_from_guide =
        guide_pose(*guide_of(options).axis, scene.start.guide_point_mm, scene.start.guide_direction,
                   scene.start.bone_from_camera_guide.translation_mm);
    info.name = sources::kExerciseSource;
    info.kind = sources::SourceKind::Simulation;
    info.image_size_px = camera.image_size_px;
    info.frames_per_second = options.frames_per_second;
  }

  Surroundings surroundings_seen_from(const RigidTransform& bone_from_camera) const {
    if (!options.surroundings.any()) return {};
    return {options.surroundings,
            bone,
            {.worked_at_mm = scene.plan.entry_mm,
             .kept_free_mm = bone_from_world.translation_mm,
             .bone_from_camera = bone_from_camera},
            options.seed};
  }

  bool is_due(const Fault& fault) const {
    if (fault.trigger == Fault::Trigger::ProbeDrawn) return slid_mm >= fault.after;
    const HandState& now = control.state();
    return now.held == Held::Guide && (now.guide_point_mm - scene.plan.entry_mm).norm() <= fault.after;
  }

  void bump(double shift_mm) {
    Random random(options.seed + 71);
    const double where = random.between(0, 2 * geometry::kPi);
    const Vector3d across(std::cos(where), std::sin(where), 0);  // in the marker's plane
    bone_from_world =
        bone_from_world * RigidTransform{Eigen::Quaterniond(Eigen::AngleAxisd(
                                             geometry::rad_from_deg(kBumpDegPerMm * shift_mm), across)),
                                         shift_mm * across};
  }

  // How the tool is held where the hand has it; as before where that cannot be.
  void hold(const HandState& now) {
    const Vector3d& eye = now.bone_from_camera.translation_mm;
    if (const auto pose = hold_probe(*probe_of(options.tools).tip_mm, now.probe_tip_mm,
                                     now.probe_tip_mm + 20 * now.probe_handle, eye))
      bone_from_probe = *pose;
    bone_from_guide = guide_pose(*guide_of(options).axis, now.guide_point_mm, now.guide_direction, eye);
  }

  float exposure() const {
    // A white surface at the tool stays below saturation, and the marker on the bone does, too, and is not in
    // the dark.
    const HandState& now = control.state();
    const RigidTransform& tool = now.held == Held::Probe ? bone_from_probe : bone_from_guide;
    const auto away_mm = [&](const Vector3d& in_bone_mm) {
      return (now.bone_from_camera.inverse() * in_bone_mm).norm();
    };
    const double nearer_mm = std::min(away_mm(tool.translation_mm), away_mm(bone_from_world.translation_mm));
    const double used_mm = std::clamp(nearer_mm, 10.0, 40.0);
    return static_cast<float>(0.85 * used_mm * used_mm);
  }

  // False: the hand has ended it.
  bool move() {
    const double dt_s = pace.next_s();
    const auto input = hand.hand(scene, control.state());
    if (!input) return false;
    pace.leave_out(input->held_up_s);
    const Vector3d tip_before = control.state().probe_tip_mm;
    const bool touched_before = control.state().touches_bone;
    const HandState& now = control.step(*input, dt_s);
    time_s += dt_s;
    if (now.held == Held::Probe && now.touches_bone && touched_before)
      slid_mm += (now.probe_tip_mm - tip_before).norm();
    hold(now);
    truth.input = *input;
    return true;
  }

  HandTruth truth;

  camera::FramePtr render() {
    truth.faults = faults.advance(
        time_s, [this](const Fault& fault) { return is_due(fault); },
        [this](const Fault& fault) {
          if (fault.kind == FaultKind::BumpedMarker) bump(fault.strength);
        });
    const HandState& now = control.state();
    truth.frame = next_index;
    truth.time_s = time_s;
    truth.hand = now;
    truth.marker_from_bone = bone_from_world.inverse();
    truth.slid_mm = slid_mm;
    if (hand.log) hand.log->add(truth);

    const RigidTransform camera_from_bone = now.bone_from_camera.inverse();
    Scene picture;
    picture.exposure = exposure();
    picture.has_bone = true;
    picture.camera_from_bone = camera_from_bone;
    add_world_marker(world_marker_of(options), camera_from_bone * bone_from_world, picture.solids);
    const bool is_probe = now.held == Held::Probe;
    add_tool(is_probe ? probe_of(options.tools) : guide_of(options),
             camera_from_bone * (is_probe ? bone_from_probe : bone_from_guide), picture.solids);
    (is_probe ? probe_surroundings : guide_surroundings).add(time_s, camera_from_bone, picture.solids);
    const camera::CameraModel model(camera, camera.lens_angle_rad(now.mark_angle_deg),
                                    options.refractive_index);
    const auto frame = std::make_shared<camera::Frame>();
    const std::uint64_t noise_seed = options.seed * 1'000'003 + static_cast<std::uint64_t>(next_index);
    renderer.render(picture, model, now.mark_angle_deg, noise_seed, *frame);
    faults.spoil(*frame, noise_seed);
    frame->index = next_index++;
    frame->timestamp_ns = static_cast<std::int64_t>(std::llround(time_s * 1e9));
    return frame;
  }
};

HandOperation::HandOperation(const SimulationOptions& options, HandOptions hand)
    : state_(std::make_unique<State>(options, std::move(hand))) {}
HandOperation::~HandOperation() = default;

const sources::SourceInfo& HandOperation::info() const { return state_->info; }

camera::FramePtr HandOperation::next() {
  if (!state_->move()) return nullptr;
  return state_->render();
}

const HandScene& HandOperation::scene() const { return state_->scene; }

geometry::RigidTransform HandOperation::marker_from_bone() const {
  return state_->staging.bone_from_world_marker.inverse();
}

}  // namespace arthronaut::simulator
