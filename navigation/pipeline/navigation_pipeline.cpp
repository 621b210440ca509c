#include "navigation/pipeline/navigation_pipeline.h"

#include <chrono>

#include "planning/geometry/error.h"

namespace arthronaut::pipeline {

namespace {

geometry::TrackedPose tracked_pose(const PictureObservation& view, std::size_t marker) {
  geometry::TrackedPose pose;
  pose.timestamp_ns = view.timestamp_ns;
  pose.is_valid = !view.is_frozen && view.stands_for(view.markers[marker]);
  if (!pose.is_valid) return pose;
  pose.target_from_source = view.markers[marker].camera_from_marker;
  pose.covariance = view.markers[marker].covariance;
  return pose;
}

// The drill that has a marker of its own, if there is one.
std::optional<std::size_t> drill_index(const std::vector<tools::Tool>& tools) {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (tools[i].kind == tools::ToolKind::Drill) return i;
  }
  return std::nullopt;
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
        drill(drill_index(with.tools.tools)),
        axes(with.axes.value_or(landmarks::scanner_axes(with.side))) {
    known_errors.camera = camera::covariance_of(with.calibration);
    if (probe) known_errors.probe_tip_mm2 = tools::tip_error_mm2(with.tools.tools[*probe]);
    known_errors.registration = guidance::BiasSums().bias();
    if (guide) guide_error = tools::axis_error(with.tools.tools[*guide]);
  }

  // Markers stand in the order of declared_markers(): world markers, then tools.
  [[nodiscard]] std::size_t marker_of_tool(std::size_t tool) const {
    return options.tools.world_markers.size() + tool;
  }

  void place_tools(FrameResult& result) const {
    const geometry::TrackedPose world_from_camera = geometry::inverse(result.camera_from_world);
    result.tools.resize(options.tools.tools.size());
    for (std::size_t i = 0; i < result.tools.size(); ++i) {
      result.tools[i].marker_id = options.tools.tools[i].marker_id;
      result.tools[i].world_from_tool =
          geometry::compose(world_from_camera, tracked_pose(result, marker_of_tool(i)));
    }
  }

  // What the camera's error does to the pose of a tool in this frame.
  [[nodiscard]] guidance::TwistPerCameraError camera_error(const FrameResult& result,
                                                           std::size_t tool) const {
    const std::size_t marker = marker_of_tool(tool);
    if (!result.stands_for(result.markers[marker])) return guidance::TwistPerCameraError::Zero();
    return guidance::twist_per_camera_error(result.markers[marker].camera_from_marker,
                                            options.tools.tools[tool].size_mm, result.camera,
                                            options.calibration);
  }

  [[nodiscard]] guidance::TwistPerCameraError camera_error_of_world(const FrameResult& result) const {
    if (!result.camera_from_world.is_valid) return guidance::TwistPerCameraError::Zero();
    const double size_mm = options.tools.find_world_marker(options.bone)->size_mm;
    return guidance::twist_per_camera_error(result.camera_from_world.target_from_source, size_mm,
                                            result.camera, options.calibration);
  }

  void place_tip(FrameResult& result) const {
    result.tip_is_valid =
        probe && options.tools.tools[*probe].tip_mm && result.tools[*probe].world_from_tool.is_valid;
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
                                         world_from_probe.target_from_source, camera_error_of_world(result),
                                         camera_error(result, *probe));
    result.tip_covariance_mm2 =
        jacobian * world_from_probe.covariance * jacobian.transpose() +
        rotation * known_errors.probe_tip_mm2 * rotation.transpose() +
        shared.per_camera_error * known_errors.camera * shared.per_camera_error.transpose();
  }

  void guide_the_drill(FrameResult& result) const {
    guidance::GuidanceInput input;
    input.plan = plan ? &*plan : nullptr;
    input.planned.length_mm = planned_length_mm;
    input.axes = axes;
    input.registration = registration ? &*registration : nullptr;
    input.camera_from_world_marker = result.camera_from_world;
    if (guide) {
      input.camera_from_guide = tracked_pose(result, marker_of_tool(*guide));
      input.axis = options.tools.tools[*guide].axis ? &*options.tools.tools[*guide].axis : nullptr;
      input.axis_error = guide_error;
      input.guide_per_camera_error = camera_error(result, *guide);
    }
    if (drill) {
      input.camera_from_drill = tracked_pose(result, marker_of_tool(*drill));
      input.drill = &options.tools.tools[*drill];
      input.drill_per_camera_error = camera_error(result, *drill);
    }
    input.known_errors = &known_errors;
    input.world_marker_per_camera_error = camera_error_of_world(result);
    input.lens_is_stale = !result.intrinsics_are_known;
    input.now_ns = result.timestamp_ns;
    result.guidance = guidance::compute_guidance(input);
    // Whatever else is missing: a frozen picture is the first thing to say.
    if (result.is_frozen) {
      result.guidance = {};
      result.guidance.state = guidance::GuidanceState::Stale;
    }
    result.guidance.timestamp_ns = result.timestamp_ns;
  }

  PipelineOptions options;
  ViewTracker view_tracker;
  std::size_t world;                               // index of the bone's world marker among the markers
  std::optional<std::size_t> probe, guide, drill;  // indices into the tools
  landmarks::AnatomicalAxes axes;
  guidance::KnownErrors known_errors;
  tools::AxisError guide_error;
  std::optional<tunnels::Tunnel> plan;
  double planned_length_mm = 0;
  std::optional<registration::RegistrationSummary> registration;
};

NavigationPipeline::NavigationPipeline(const PipelineOptions& options)
    : NavigationPipeline(options, markers::make_tracker(markers::declared_markers(options.tools))) {}

NavigationPipeline::NavigationPipeline(const PipelineOptions& options,
                                       std::unique_ptr<markers::MarkerTracker> markers)
    : state_(std::make_unique<State>(options, std::move(markers))) {}

NavigationPipeline::~NavigationPipeline() = default;

void NavigationPipeline::process(const camera::Frame& frame, FrameResult& result) {
  const auto begin = std::chrono::steady_clock::now();
  state_->view_tracker.observe(frame, result);
  result.camera_from_world = tracked_pose(result, state_->world);
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

void NavigationPipeline::set_registration(
    const std::optional<registration::RegistrationSummary>& marker_from_bone,
    const std::optional<guidance::RegistrationBias>& bias) {
  state_->registration = marker_from_bone;
  state_->known_errors.registration = bias ? *bias : guidance::BiasSums().bias();
}

const PipelineOptions& NavigationPipeline::options() const { return state_->options; }

}  // namespace arthronaut::pipeline
