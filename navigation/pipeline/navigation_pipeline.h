// One frame in, everything that is known about it out: lens, markers, tip, guidance. Thread-free and
// deterministic: the window's worker thread, the command line, replay and tests all call the same process().
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/frame.h"
#include "navigation/guidance/guidance.h"
#include "navigation/lens/lens_tracker.h"
#include "navigation/markers/body_pose.h"
#include "navigation/markers/marker_tracker.h"
#include "navigation/pipeline/view_tracker.h"
#include "navigation/registration/registration.h"
#include "navigation/tools/tool_set.h"
#include "navigation/tracker/tracker_poses.h"
#include "planning/bones/bone.h"
#include "planning/geometry/tracked_pose.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::pipeline {

struct PipelineOptions {
  camera::Calibration calibration;
  double refractive_index = 1.0;  // of the working medium
  camera::FluidModel fluid_model = camera::FluidModel::FlatPort;
  bool follow_lens = true;  // false: intrinsics stay at lens angle 0 (for comparison only)
  tools::ToolSet tools;
  bones::BoneKind bone = bones::BoneKind::Femur;  // whose world marker is the world
  bones::Side side = bones::Side::Right;
  std::string probe_name = "probe";
  std::string guide_name = "femoral guide";
  // In which offsets are said; empty: the scanner's. landmarks::anatomical_axes() makes them.
  std::optional<landmarks::AnatomicalAxes> axes = std::nullopt;
  // What else is known of `calibration`, for the record: who was calibrated when, and how well. Its own
  // numbers are not looked at. Null: nothing.
  std::shared_ptr<const camera::CalibrationRecord> calibrated = nullptr;
};

struct ToolPose {
  int marker_id = 0;  // the tool's; of several, the first
  geometry::TrackedPose world_from_tool;
};

// What one frame says. Immutable once published. Everything of the base is about the picture alone; what
// follows is about the knee and is valid only in a live picture whose intrinsics are known.
struct FrameResult : PictureObservation {  // markers: world markers first, then the tools'
  // What is fixed to them, from all of its markers: the world markers' bodies, then the tools. Empty in what
  // is made from a record.
  std::vector<markers::BodyObservation> bodies;
  geometry::TrackedPose camera_from_world;  // the world marker of the bone
  // Where tools.json names an outside tracker: what it says of each body, in place of the pictures, and the
  // bone's world in its frame. Where the camera is in that frame nobody knows: camera_from_world is not valid
  // then, there are no bodies, and nothing is drawn over the picture.
  tracker::TrackerPoses outside;
  geometry::TrackedPose tracker_from_world;
  // By whichever eye.
  [[nodiscard]] bool world_is_seen() const {
    return camera_from_world.is_valid || tracker_from_world.is_valid;
  }
  std::vector<ToolPose> tools;  // world_from_tool of each tool, in the order of the tool set
  bool tip_is_valid = false;
  Eigen::Vector3d tip_in_world_mm = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> shaft_in_world;  // see tools::shaft_direction
  // Of the tip in the world: poses, camera and the tip's own calibration.
  Eigen::Matrix3d tip_covariance_mm2 = Eigen::Matrix3d::Zero();
  // For the sums of the registration that this tip draws (guidance::BiasSums).
  guidance::TipSensitivity tip_sensitivity;
  guidance::GuidanceNumbers guidance;
  double processing_ms = 0;  // of process(): not part of what replay compares
};

// What the frame says of the body of this id: its pose where it stands for one, and why not where it does
// not. Of a frame without bodies, that of the marker.
struct BodyView {
  std::optional<geometry::RigidTransform> camera_from_body;
  markers::MarkerState state = markers::MarkerState::NotSeen;
};
[[nodiscard]] BodyView body_in(const FrameResult& result, int id);

class NavigationPipeline {
 public:
  // Throws InvalidInput when options break their contract (no world marker for the bone, unusable
  // calibration).
  explicit NavigationPipeline(const PipelineOptions& options);
  // The same with another way to find the markers, which must observe declared_markers(options.tools) in that
  // order.
  NavigationPipeline(const PipelineOptions& options, std::unique_ptr<markers::MarkerTracker> markers);
  ~NavigationPipeline();

  // Frames in order of time. `result` is reused from call to call so that nothing is allocated after the
  // first frames. Throws InvalidInput when the frame's size is not the camera's; never on what a picture
  // shows. A marker that is lost, a lens angle that is not known or a frozen picture makes poses, tip and
  // guidance invalid in this very frame.
  //
  // outside: what the outside tracker says at this frame, where the tools name one; null: nothing. A picture
  // of unknown intrinsics takes nothing away from it, a frozen one does: what the screen shows is not now.
  void process(const camera::Frame& frame, FrameResult& result,
               const tracker::TrackerPoses* outside = nullptr);

  // What guidance is computed from. Takes effect with the next frame.
  void set_plan(const std::optional<tunnels::Tunnel>& plan, double planned_length_mm);
  // The bone's surface, in its frame, that a drill is about to leave; null: its exit is the plan's alone.
  void set_bone(std::shared_ptr<const geometry::Surface> bone);
  // bias: how the registration follows the errors of probe and camera, from the sums over its points; without
  // one, what is taken where nobody knows how it was drawn.
  void set_registration(const std::optional<registration::RegistrationSummary>& marker_from_bone,
                        const std::optional<guidance::RegistrationBias>& bias = std::nullopt);

  [[nodiscard]] const PipelineOptions& options() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::pipeline
