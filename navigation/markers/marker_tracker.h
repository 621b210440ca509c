// Finds the declared square markers in a raw, distorted frame and gives the pose of each with its error, or
// the reason why not. One tracker implements the interface for the product; tests and benchmarks hold another
// one, on OpenCV's ArUco detector, against it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/tools/tool_set.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {

enum class MarkerState {
  Tracked,
  NotSeen,    // nothing that looks like it; the reason is not known
  OutOfView,  // where it was last seen leaves the view
  TooSmall,
  TooOblique,
  Covered,
  Glare,
  Blur,
  Ambiguous,    // two poses explain the corners alike
  Duplicate,    // its id is seen twice
  Doubtful,     // found, but the residual is too large to stand for
  Disagreeing,  // of a body of several markers alone: they lie where the body does not allow
};
[[nodiscard]] std::string_view to_text(MarkerState state);

struct DeclaredMarker {
  int id = 0;          // in DICT_4X4_50
  double size_mm = 4;  // side of the black square
};

struct MarkerObservation {
  int id = 0;
  MarkerState state = MarkerState::NotSeen;
  // The rest is meaningful when is_tracked().
  std::array<Eigen::Vector2d, 4>
      corners_px;  // raw pixels: the marker's top-left, top-right, bottom-right, bottom-left
  // Marker frame: x right, y up, z out of the printed face. Of the middle of the exposure of the row that its
  // centre is in; of two fields, of the moment between them.
  geometry::RigidTransform camera_from_marker;
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  // body twist (v mm, w rad)
  double rms_px = 0;           // corner reprojection error on the distorted frame
  double ambiguity_ratio = 0;  // reprojection error of the other planar solution / of this one
  [[nodiscard]] bool is_tracked() const { return state == MarkerState::Tracked; }
};

// A square that a search of the whole frame looked at: for whoever asks why a marker was not found.
struct MarkerCandidate {
  static constexpr int kNoCode = -1;
  std::array<Eigen::Vector2d, 4> corners_px;  // clockwise, any of them first; good to about 2 px
  int id = kNoCode;                           // of the declared code that was read in it
};

class MarkerTracker {
 public:
  virtual ~MarkerTracker() = default;
  // One observation for each declared marker, in their order; valid until the next call. Of two in one place
  // the one read worse is not tracked. Frames in order of time; the camera is that of this frame's lens
  // angle. Never throws on what a picture shows; throws InvalidInput when the frame's size is not the
  // camera's.
  virtual std::span<const MarkerObservation> track(const camera::GrayView& frame,
                                                   const camera::CameraModel& camera,
                                                   std::int64_t timestamp_ns) = 0;
  // What the last call's search looked at; empty when it had no need of one. Valid until the next call.
  [[nodiscard]] virtual std::span<const MarkerCandidate> candidates() const { return {}; }
  virtual void reset() = 0;  // forget the past: another source
};

// The tracker: finds squares in the undistorted outline of dark regions,
// measures every edge of the code to a small part of a pixel in linear light on the raw frame, follows the
// marker through partial cover, glare and motion blur by prediction, and reports a pose only when its edges
// (or its whole code, when smeared over more than a cell) confirm it both ways. What is tracked comes first;
// a marker that is lost, or was never seen, is sought in every frame for a second, then in four frames by a
// part of that search in each, and
// a square of which a part is hidden is sought in a part of the picture at a time. rms_px is how far the
// measured corners lie from the pose's. No memory is allocated after the first frames. Throws InvalidInput
// when a marker is declared twice, an id is outside 0..49 or a size is not above 0.
[[nodiscard]] std::unique_ptr<MarkerTracker> make_tracker(std::span<const DeclaredMarker> declared);

// Every marker that the tools declare: world markers first; of a body of several, all of them in its order.
// None where an outside tracker sees the bodies.
[[nodiscard]] std::vector<DeclaredMarker> declared_markers(const tools::ToolSet& tools);

}  // namespace arthronaut::markers
