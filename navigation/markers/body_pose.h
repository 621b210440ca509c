// The one pose of a body that carries several markers, from all of them that are seen in a frame: the pose
// whose projected corners lie nearest to where the markers' own poses have them, each weighted by that
// marker's covariance and by how well its place on the body is known. What one marker alone cannot tell,
// which of the two tilts that its corners allow is the right one, another marker decides.
//
// A marker that lies elsewhere than the rest of the body says, by more than the errors allow, is left out and
// named; where two disagree and no third tells which is wrong, there is no pose.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "navigation/markers/marker_tracker.h"

namespace arthronaut::markers {

struct Body {
  int id = 0;             // of its first marker
  std::size_t first = 0;  // place of its first marker among declared_markers(); the others follow it
  std::vector<tools::BodyMarker> markers;
};

// The world markers' bodies, then the tools', in their orders.
[[nodiscard]] std::vector<Body> declared_bodies(const tools::ToolSet& tools);

struct BodyObservation {
  static constexpr int kNone = -1;
  int id = 0;  // the body's
  // As of one marker; Disagreeing: see above. Without any marker that may be used, the reason of the one that
  // came nearest to it.
  MarkerState state = MarkerState::NotSeen;
  // The rest is meaningful when is_tracked().
  geometry::RigidTransform camera_from_body;
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  // body twist (v mm, w rad)
  std::uint32_t used = 0;  // bit i: the body's marker i is part of the pose
  // Id of the marker that was left out because it disagrees; also said while the state is Disagreeing and
  // there is one that disagrees most.
  int odd_marker = kNone;
  // Mean square of the markers' differences over their predicted variances; 1 is as predicted. 0: one marker.
  double misfit = 0;
  [[nodiscard]] bool is_tracked() const { return state == MarkerState::Tracked; }
  [[nodiscard]] int used_count() const;
};

struct BodyPoseOptions {
  // The sum of squared differences over predicted variances of two markers, six in number, at most; each
  // further marker adds a third. Eight sigma in one direction: markers that are measured in pictures are off
  // by up to twice the variance that they say.
  double max_disagreement = 64;
  // One reading of ambiguous markers counts when every other fits worse by this much in the same sum.
  double clear_difference = 16;
  // Which of three or more markers is the wrong one is clear when leaving out any other fits worse by this.
  double clear_odd_one = 9;
};

// `observations` are of the body's markers, in their order. `camera` is the frame's. A body whose one marker
// is its frame has that marker's pose, to the last bit. Allocates nothing; never throws.
[[nodiscard]] BodyObservation observe_body(const Body& body, std::span<const MarkerObservation> observations,
                                           const camera::CameraModel& camera,
                                           const BodyPoseOptions& options = {});

}  // namespace arthronaut::markers
