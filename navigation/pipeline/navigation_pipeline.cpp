#include "navigation/pipeline/navigation_pipeline.h"

#include <array>
#include <chrono>
#include <span>

#include "navigation/markers/seen_bodies.h"
#include "planning/geometry/error.h"

namespace arthronaut::pipeline {

namespace {

geometry::TrackedPose tracked_pose(const FrameResult& result, std::size_t body) {
  geometry::TrackedPose pose;
  pose.timestamp_ns = result.timestamp_ns;
  pose.is_valid = result.poses_stand() && result.bodies[body].is_tracked();
  if (!pose.is_valid) return pose;
  pose.target_from_source = result.bodies[body].camera_from_body;
  pose.covariance = result.bodies[body].covariance;
  return pose;
}

// The corners of all of a body's markers, in its frame, four a marker.
std::vector<Eigen::Vector3d> corners_of(const markers::Body& body) {
  std::vector<Eigen::Vector3d> corners_mm;
  for (const tools::BodyMarker& marker : body.markers) {
    const double half_mm = marker.size_mm / 2;
    for (const double x : {-half_mm, half_mm})
      for (const double y : {-half_mm, half_mm})
        corners_mm.push_back(marker.body_from_marker * Eigen::Vector3d(x, y, 0));
  }
  return corners_mm;
}

// The drills that have a marker of their own.
std::vector<std::size_t> drill_indices(const std::vector<tools::Tool>& tools) {
  std::vector<std::size_t> drills;
  for (std::size_t i = 0; i < tools.size(); ++i)
    if (tools[i].kind == tools::ToolKind::Drill) drills.push_back(i);
  return drills;
}

std::optional<std::size_t> index_of(const std::vector<tools::Tool>& tools, const std::string& name) {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (tools[i].name == name) return i;
  }
  return std::nullopt;
}

std::size_t world_marker_index(const PipelineOptions& options) {
  const auto& world_markers = options.tools.world_markers;
  for (std::size_t i = 0; i < world_markers.size(); ++i) {
    if (world_markers[i].bone == options.bone) return i;
  }
  throw InvalidInput("the tools declare no world marker for the " +
                     std::string(bones::to_text(options.bone)));
}

ViewTrackerOptions view_options(const PipelineOptions& options) {
  ViewTrackerOptions view;
  view.calibration = options.calibration;
  view.refractive_index = options.refractive_index;
  view.fluid_model = options.fluid_model;
  view.follow_lens = options.follow_lens;
  return view;
}

}  // namespace

struct NavigationPipeline::State {
  State(const PipelineOptions& with, std::unique_ptr<markers::MarkerTracker> markers)
      : options(with),
        view_tracker(view_options(with), std::move(markers)),
        world(world_marker_index(with)),
        probe(index_of(with.tools.tools, with.probe_name)),
        guide(index_of(with.tools.tools, with.guide_name)),
        drills(drill_indices(with.tools.tools)),
        drills_in_frame(drills.size()),
        bodies(with.tools),
        axes(with.axes.value_or(landmarks::scanner_axes(with.side))) {
    for (const markers::Body& body : bodies.declared()) corners_mm.push_back(corners_of(body));
    known_errors.camera = camera::covariance_of(with.calibration);
    if (probe) known_errors.probe_tip_mm2 = tools::tip_error_mm2(with.tools.tools[*probe]);
    known_errors.registration = guidance::BiasSums().bias();
    if (guide) guide_error = tools::axis_error(with.tools.tools[*guide]);
  }

  // Bodies stand in the order of declared_bodies(): world markers', then tools.
  [[nodiscard]] std::size_t body_of_tool(std::size_t tool) const {
    return options.tools.world_markers.size() + tool;
  }

  [[nodiscard]] bool is_outside() const { return options.tools.tracker.has_value(); }

  void take_outside(const tracker::TrackerPoses* outside, FrameResult& result) const {
    result.bodies.clear();
    result.camera_from_world = {};
    if (outside != nullptr)
      result.outside = *outside;
    else
      tracker::set_all(options.tools, tracker::BodyState::NotConnected, result.outside);
    result.tracker_from_world = pose_of_body(result, world);
  }

  // In the camera's frame or the outside tracker's, whichever sees the bodies.
  [[nodiscard]] geometry::TrackedPose pose_of_body(const FrameResult& result, std::size_t body) const {
    if (!is_outside()) return tracked_pose(result, body);
    geometry::TrackedPose pose = tracker::pose_of(result.outside, bodies.declared()[body].id,
                                                  result.timestamp_ns, *options.tools.tracker);
    pose.is_valid = pose.is_valid && !result.is_frozen && !result.is_repeating;
    return pose;
  }

  [[nodiscard]] const geometry::TrackedPose& world_pose(const FrameResult& result) const {
    return is_outside() ? result.tracker_from_world : result.camera_from_world;
  }

  void place_tools(FrameResult& result) const {
    const geometry::TrackedPose world_from_reference = geometry::inverse(world_pose(result));
    result.tools.resize(options.tools.tools.size());
    for (std::size_t i = 0; i < result.tools.size(); ++i) {
      result.tools[i].marker_id = options.tools.tools[i].marker_id;
      result.tools[i].world_from_tool =
          geometry::compose(world_from_reference, pose_of_body(result, body_of_tool(i)));
    }
  }

  // What the camera's error does to the pose of a body in this frame, by the corners that the pose is from;
  // nothing to no pose. Empty where it cannot be said.
  [[nodiscard]] std::optional<guidance::TwistPerCameraError> camera_error_of_body(const FrameResult& result,
                                                                                  std::size_t body) const {
    if (is_outside()) return guidance::TwistPerCameraError::Zero();
    const markers::BodyObservation& seen = result.bodies[body];
    if (!result.intrinsics_are_known || !seen.is_tracked()) return guidance::TwistPerCameraError::Zero();
    std::array<Eigen::Vector3d, 4 * tools::kMostMarkersOfBody> used_mm;
    std::size_t count = 0;
    for (std::size_t i = 0; i < corners_mm[body].size(); ++i)
      if (seen.used & (1U << (i / 4))) used_mm[count++] = corners_mm[body][i];
    return guidance::twist_per_camera_error(
        seen.camera_from_body, std::span<const Eigen::Vector3d>(used_mm.data(), count), result.camera);
  }

  [[nodiscard]] std::optional<guidance::TwistPerCameraError> camera_error(const FrameResult& result,
                                                                          std::size_t tool) const {
    return camera_error_of_body(result, body_of_tool(tool));
  }

  [[nodiscard]] std::optional<guidance::TwistPerCameraError> camera_error_of_world(
      const FrameResult& result) const {
    return camera_error_of_body(result, world);
  }

  void place_tip(FrameResult& result) const {
    result.tip_is_valid =
        probe && options.tools.tools[*probe].tip_mm && result.tools[*probe].world_from_tool.is_valid;
    if (!result.tip_is_valid) return;
    const auto of_world = camera_error_of_world(result), of_probe = camera_error(result, *probe);
    // A tip of which nobody can say how far it is off is none.
    result.tip_is_valid = of_world && of_probe;
    if (!result.tip_is_valid) return;
    const geometry::TrackedPose& world_from_probe = result.tools[*probe].world_from_tool;
    const Eigen::Vector3d& tip_in_probe_mm = *options.tools.tools[*probe].tip_mm;
    result.tip_in_world_mm = world_from_probe.target_from_source * tip_in_probe_mm;
    const std::optional<Eigen::Vector3d> shaft_in_probe = tools::shaft_direction(options.tools.tools[*probe]);
    if (shaft_in_probe) result.shaft_in_world = world_from_probe.target_from_source.rotate(*shaft_in_probe);
    // d tip / d body twist = R [I, -[tip]x].
    const Eigen::Matrix3d rotation = world_from_probe.target_from_source.matrix();
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << rotation, -rotation * geometry::cross_matrix(tip_in_probe_mm);
    // ... and [I, -[tip]x] of the twist on the left, in which the camera's error is.
    Eigen::Matrix<double, 3, 6> move;
    move << Eigen::Matrix3d::Identity(), -geometry::cross_matrix(result.tip_in_world_mm);
    guidance::TipSensitivity& shared = result.tip_sensitivity;
    shared.tip_mm = result.tip_in_world_mm;
    shared.per_tip_error = rotation;
    shared.per_camera_error = move * guidance::relative_twist_per_camera_error(
                                         world_from_probe.target_from_source, *of_world, *of_probe);
    result.tip_covariance_mm2 =
        jacobian * world_from_probe.covariance * jacobian.transpose() +
        rotation * known_errors.probe_tip_mm2 * rotation.transpose() +
        shared.per_camera_error * known_errors.camera * shared.per_camera_error.transpose();
  }

  void guide_the_drill(FrameResult& result) {
    guidance::GuidanceInput input;
    input.plan = plan ? &*plan : nullptr;
    input.planned_length_mm = planned_length_mm;
    input.axes = axes;
    input.registration = registration ? &*registration : nullptr;
    input.camera_from_world_marker = world_pose(result);
    if (guide) {
      input.camera_from_guide = pose_of_body(result, body_of_tool(*guide));
      input.axis = options.tools.tools[*guide].axis ? &*options.tools.tools[*guide].axis : nullptr;
      input.axis_error = guide_error;
      input.guide_per_camera_error = camera_error(result, *guide);
    }
    for (std::size_t i = 0; i < drills.size(); ++i)
      drills_in_frame[i] = {&options.tools.tools[drills[i]], pose_of_body(result, body_of_tool(drills[i])),
                            camera_error(result, drills[i])};
    input.drills = drills_in_frame;
    input.drill_before = told_drill;
    input.bone = bone.get();
    input.known_errors = &known_errors;
    input.world_marker_per_camera_error = camera_error_of_world(result);
    input.lens_is_stale = !is_outside() && !result.intrinsics_are_known;
    input.now_ns = result.timestamp_ns;
    result.guidance = guidance::compute_guidance(input);
    if (result.guidance.drill) told_drill = result.guidance.drill->marker_id;
    // Whatever else is missing: what is wrong with the picture itself is the first thing to say.
    if (result.is_frozen || (result.is_torn && !is_outside())) {
      result.guidance = {};
      result.guidance.state =
          result.is_frozen ? guidance::GuidanceState::Stale : guidance::GuidanceState::PictureTorn;
    }
    result.guidance.timestamp_ns = result.timestamp_ns;
  }

  PipelineOptions options;
  ViewTracker view_tracker;
  std::size_t world;                        // index of the bone's world marker among the bodies
  std::optional<std::size_t> probe, guide;  // indices into the tools
  std::vector<std::size_t> drills;          // likewise
  std::vector<guidance::DrillInput> drills_in_frame;
  std::optional<int> told_drill;  // the marker of the one that was told of last
  markers::SeenBodies bodies;
  std::vector<std::vector<Eigen::Vector3d>> corners_mm;  // of each body
  landmarks::AnatomicalAxes axes;
  guidance::KnownErrors known_errors;
  tools::AxisError guide_error;
  std::optional<tunnels::Tunnel> plan;
  double planned_length_mm = 0;
  std::shared_ptr<const geometry::Surface> bone;
  std::optional<registration::RegistrationSummary> registration;
};

BodyView body_in(const FrameResult& result, int id) {
  BodyView view;
  const auto take = [&](const auto& seen, const geometry::RigidTransform& pose) {
    view.state = seen.state;
    if (seen.is_tracked() && result.poses_stand()) view.camera_from_body = pose;
  };
  for (const markers::BodyObservation& body : result.bodies)
    if (body.id == id) take(body, body.camera_from_body);
  if (!result.bodies.empty()) return view;
  for (const markers::MarkerObservation& marker : result.markers)
    if (marker.id == id) take(marker, marker.camera_from_marker);
  return view;
}

NavigationPipeline::NavigationPipeline(const PipelineOptions& options)
    : NavigationPipeline(options, markers::make_tracker(markers::declared_markers(options.tools))) {}

NavigationPipeline::NavigationPipeline(const PipelineOptions& options,
                                       std::unique_ptr<markers::MarkerTracker> markers)
    : state_(std::make_unique<State>(options, std::move(markers))) {}

NavigationPipeline::~NavigationPipeline() = default;

void NavigationPipeline::process(const camera::Frame& frame, FrameResult& result,
                                 const tracker::TrackerPoses* outside) {
  const auto begin = std::chrono::steady_clock::now();
  state_->view_tracker.observe(frame, result);
  if (state_->is_outside()) {
    state_->take_outside(outside, result);
  } else {
    state_->bodies.observe(result.markers, result.camera, result.bodies);
    result.camera_from_world = tracked_pose(result, state_->world);
  }
  state_->place_tools(result);
  state_->place_tip(result);
  state_->guide_the_drill(result);
  result.processing_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

void NavigationPipeline::set_plan(const std::optional<tunnels::Tunnel>& plan, double planned_length_mm) {
  state_->plan = plan;
  state_->planned_length_mm = planned_length_mm;
}

void NavigationPipeline::set_bone(std::shared_ptr<const geometry::Surface> bone) {
  state_->bone = std::move(bone);
}

void NavigationPipeline::set_registration(
    const std::optional<registration::RegistrationSummary>& marker_from_bone,
    const std::optional<guidance::RegistrationBias>& bias) {
  state_->registration = marker_from_bone;
  state_->known_errors.registration = bias ? *bias : guidance::BiasSums().bias();
}

const PipelineOptions& NavigationPipeline::options() const { return state_->options; }

}  // namespace arthronaut::pipeline
