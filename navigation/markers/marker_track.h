// One declared marker as it is followed from frame to frame: where it was, how it moves, and the attempt to
// measure it at a supposed pose.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/edge_pose.h"
#include "navigation/markers/edge_profiles.h"
#include "navigation/markers/marker_tracker.h"

namespace arthronaut::markers {

// What the picture is smeared by: the same for all markers of a camera, learnt while they are tracked.
struct CameraSmear {
  double sigma_px = 1.2;
  double exposure_share = 0.5;  // of the time between frames
  BloomPrior bloom;
};

class MarkerTrack {
 public:
  MarkerTrack(const DeclaredMarker& marker, const MarkerCode& code);

  // Where the marker should be at this time; nullopt when it was never seen or too long ago.
  [[nodiscard]] std::optional<geometry::RigidTransform> predicted(std::int64_t timestamp_ns) const;

  // Measures the marker around this pose, to `reach` cells to either side. Fills the observation; true when
  // tracked.
  bool measure(const LinearImage& image, const camera::CameraModel& camera,
               const geometry::RigidTransform& start, bool is_found, std::int64_t timestamp_ns,
               CameraSmear& smear, MarkerObservation& observation);

  // The observation of this frame is final: remembers it.
  void follow(const MarkerObservation& observation, std::int64_t timestamp_ns);
  void forget();

  [[nodiscard]] const DeclaredMarker& marker() const { return marker_; }
  bool is_duplicate = false;  // as of the last search of the whole frame

 private:
  struct Sighting {
    geometry::RigidTransform camera_from_marker;
    std::int64_t timestamp_ns = 0;
  };
  // Twist from one frame to the next if the marker goes on from the last sighting to this pose; zero when not
  // known.
  [[nodiscard]] geometry::Vector6d twist_to(const geometry::RigidTransform& pose,
                                            std::int64_t timestamp_ns) const;
  // The smear under which the picture looks most like the marker at this pose, when nothing is known of the
  // motion: the motion over the exposure as a body twist.
  [[nodiscard]] geometry::Vector6d likely_motion(const LinearImage& image, const camera::CameraModel& camera,
                                                 const geometry::RigidTransform& pose, int search_px,
                                                 const CameraSmear& smear);
  void follow_from(const MarkerObservation& observation, std::int64_t timestamp_ns);
  [[nodiscard]] MarkerState judge(const EdgePose& fit, const MarkerObservation& observation,
                                  const std::optional<SquarePose>& other, bool is_found) const;
  [[nodiscard]] MarkerState reason_of_loss(const camera::CameraModel& camera,
                                           const geometry::RigidTransform& pose) const;

  DeclaredMarker marker_;
  int cells_;
  std::vector<EdgeSample> samples_;
  std::vector<EdgeMeasurement> measurements_;
  std::vector<char> is_inlier_;
  std::optional<Sighting> last_, before_;
};

}  // namespace arthronaut::markers
