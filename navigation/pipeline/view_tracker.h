// The eyes of the pipeline: one picture in; lens angle, camera of this very frame and marker poses out. It
// knows no bone and no plan, so `arthronaut track` uses it alone.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "navigation/camera/frame.h"
#include "navigation/lens/lens_tracker.h"
#include "navigation/markers/marker_tracker.h"
#include "navigation/strokes/poses_file.h"

namespace arthronaut::pipeline {

struct ViewTrackerOptions {
  camera::Calibration calibration;
  double refractive_index = 1.0;  // of the working medium
  camera::FluidModel fluid_model = camera::FluidModel::FlatPort;
  bool follow_lens = true;      // false: the intrinsics stay at lens angle 0
  double frozen_after_s = 0.3;  // the same content for this long is no live picture
  // How far the principal point may be unknown (2 sigma) before poses are doubtful. 3 px are 0.23 deg at the
  // standard scope.
  double max_principal_point_error_px = 3.0;
};

// What one picture shows.
struct PictureObservation {
  std::int64_t frame_index = 0;
  std::int64_t timestamp_ns = 0;
  lens::LensObservation lens;
  // Focal length and lens angle are known well enough for this scope: a mark lost for too long, a rim off its
  // track (a slipped coupler), out of view or of another radius than calibrated (lens.zoom) makes it false,
  // and no pose of this frame is to be trusted.
  bool intrinsics_are_known = false;
  bool is_frozen = false;         // the same content again and again: see frozen_picture.h
  bool is_repeating = false;      // see FrozenPicture::Signs: no pose stands, whatever comes
  bool is_torn = false;           // of two moments: intrinsics_are_known is false then
  bool is_blank = false;          // no light or no signal
  double repeat_share = 0;        // of the pictures of the last 0.4 s
  std::int64_t shown_for_ns = 0;  // since the first picture that showed the same: see repeated_pictures.h
  camera::CameraModel camera;     // of this frame
  std::vector<markers::MarkerObservation> markers;   // one for each declared marker, in their order
  std::vector<markers::MarkerCandidate> candidates;  // of this frame's search for markers, when there was one
  // Whether any pose of this picture may be used, whatever the markers say of themselves.
  [[nodiscard]] bool poses_stand() const { return intrinsics_are_known && !is_frozen && !is_repeating; }
  // Whether that of a marker may; its own state says more.
  [[nodiscard]] bool stands_for(const markers::MarkerObservation& marker) const {
    return poses_stand() && marker.is_tracked();
  }
};

// Stateful over the frames of one source; one thread at a time; deterministic.
class ViewTracker {
 public:
  // Throws InvalidInput for an unusable calibration.
  ViewTracker(const ViewTrackerOptions& options, std::unique_ptr<markers::MarkerTracker> markers);
  ~ViewTracker();

  // Frames in order of time. `view` is reused from call to call. Throws InvalidInput when the frame's size is
  // not that of the calibration; never on what a picture shows. Allocates nothing of its own after the first
  // frames.
  void observe(const camera::Frame& frame, PictureObservation& view);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Appends the rows of poses.csv: the poses that the view stands for.
void append_pose_rows(const PictureObservation& view, std::vector<strokes::PoseRow>& rows);

}  // namespace arthronaut::pipeline
