// One declared marker as it is followed from frame to frame: where it was, how it moves, and the attempt to
// measure it at a supposed pose.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/camera_smear.h"
#include "navigation/markers/direct_alignment.h"
#include "navigation/markers/edge_pose.h"
#include "navigation/markers/edge_profiles.h"
#include "navigation/markers/marker_motion.h"
#include "navigation/markers/marker_tracker.h"

namespace arthronaut::markers {

// One frame, and what all markers of the camera share.
struct TrackedFrame {
  const LinearImage& image;
  const camera::CameraModel& camera;
  std::int64_t timestamp_ns = 0;
  CameraSmear& smear;
  DirectFit* direct = nullptr;  // none: edge profiles alone
};

// When a measured pose stands. docs/thresholds.md says where the numbers come from.
struct MarkerTrackOptions {
  double min_cell_px = 3;         // smaller ones are not measured: TooSmall
  double min_direct_cell_px = 6;  // smaller ones are measured by their edges alone
  double smeared_px = 3;          // a motion over the exposure from which on the direct fit is the better one
  // The corners that single edges make under a direct fit lie no farther from it, or it fits something else;
  // without an edge pose to agree with, they have to be its own all the more.
  double max_direct_rms_px = 1.1, max_lone_rms_px = 0.5;
  double corner_sigma_px = 0.05;
  // At first sight the motion is a guess: so much more may be wrong with each corner.
  double found_corner_sigma_px = 0.15;
  // The other pose that a square allows is out of the question when it explains the corners this many times
  // worse, or the grey levels this many times.
  double clear_ratio = 10, other_noise = 1.15;
  DirectOptions direct;
};

class MarkerTrack {
 public:
  MarkerTrack(const DeclaredMarker& marker, const MarkerCode& code, const MarkerTrackOptions& options = {});

  // Where the marker should be at this time; nullopt when it was never seen or too long ago.
  [[nodiscard]] std::optional<geometry::RigidTransform> predicted(std::int64_t timestamp_ns) const {
    return motion_.predicted(timestamp_ns);
  }

  // Measures the marker around this pose. Fills the observation; true when tracked. `is_found`: the pose
  // comes from a search and not from the frames before.
  bool measure(const TrackedFrame& frame, const geometry::RigidTransform& start, bool is_found,
               MarkerObservation& observation);

  // The observation of this frame is final: remembers it.
  void follow(const MarkerObservation& observation, std::int64_t timestamp_ns);
  void forget();

  [[nodiscard]] const DeclaredMarker& marker() const { return marker_; }
  bool is_duplicate = false;  // as of the last search of the whole frame

 private:
  // The smear under which the picture looks most like the marker at this pose, when nothing is known of the
  // motion: the motion over the exposure as a body twist.
  [[nodiscard]] geometry::Vector6d likely_motion(const TrackedFrame& frame,
                                                 const geometry::RigidTransform& pose, int search_px);
  // measure(), from the edges on.
  bool measure_from_edges(const TrackedFrame& frame, const geometry::RigidTransform& start, bool is_found,
                          const EdgePose& fit, const Smear& picture, const SmearTrend& trend,
                          MarkerObservation& observation);
  // Edge profiles: refines the pose and the motion of `picture`.
  [[nodiscard]] EdgePose fit_edges(const TrackedFrame& frame, const geometry::RigidTransform& start,
                                   bool is_found, Smear& picture, SmearTrend& trend);
  // Direct fit from a pose and a motion.
  [[nodiscard]] DirectPose fit_directly(const TrackedFrame& frame, const geometry::RigidTransform& start,
                                        const geometry::Vector6d& motion, const DirectOptions& options);
  // The same with motions from a grid, where none is known; the best, usable or not.
  [[nodiscard]] DirectPose try_motions(const TrackedFrame& frame, const geometry::RigidTransform& start);
  // From here on the pose in the observation is judged: what the edges say, and the direct fit where there is
  // one.
  void report_edges(const TrackedFrame& frame, const EdgePose& fit, const Smear& picture, bool is_found,
                    MarkerObservation& observation);
  void report_direct(const TrackedFrame& frame, const DirectPose& fit, double max_rms_px,
                     MarkerObservation& observation);
  // A pose that is good enough to go on from, not to stand for; of several in one frame, the one whose edges
  // agree best.
  void go_on_from(const EdgePose& fit);

  MarkerTrackOptions options_;
  DeclaredMarker marker_;
  MarkerCode code_;
  int cells_;
  std::vector<EdgeSample> samples_;
  std::vector<EdgeMeasurement> measurements_;
  std::vector<char> is_inlier_;
  MarkerMotion motion_;
  struct Guess {
    geometry::RigidTransform camera_from_marker;
    double misfit = 0;
  };
  std::optional<Guess> guess_;  // of this frame, until it is final
  // What a search led to in this frame that did not stand: another start that leads there is the same.
  struct Refused {
    EdgePose edges;
    geometry::Vector6d motion;
    MarkerObservation observation;
  };
  std::optional<Refused> refused_;
  // A pose that explained this frame's picture and yet did not stand: another one that does is no better.
  std::optional<geometry::RigidTransform> explained_;
};

}  // namespace arthronaut::markers
