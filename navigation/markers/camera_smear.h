// What smears the pictures of a camera, learnt from the markers that are tracked.
#pragma once

#include "navigation/markers/edge_pose.h"
#include "navigation/markers/edge_profiles.h"
#include "navigation/markers/row_timing.h"

namespace arthronaut::markers {

// What the picture is smeared by: the same for all markers of a camera, learnt while they are tracked.
struct CameraSmear {
  double sigma_px = 1.2;
  double exposure_share = 0.5;  // of the time between frames
  double gamma = 1.6;           // of the grey levels, as the direct fits find it
  BloomPrior bloom;
  RowTiming rows;
};

// A motion in the image plane at the marker's depth, as a body twist.
[[nodiscard]] geometry::Vector6d twist_of(const Eigen::Vector2d& motion_px, const camera::CameraModel& camera,
                                          const geometry::RigidTransform& camera_from_marker);

// How the profiles want the motion over the exposure changed, in pixels; zero when they hardly tell.
[[nodiscard]] Eigen::Vector2d motion_step(const SmearTrend& trend);

// From a motion over the exposure that was expected and one that was found; little motions teach nothing.
void learn_exposure(const geometry::Vector6d& expected, const geometry::Vector6d& found, double px_per_mm,
                    CameraSmear& smear);
// From the edges of a marker that is tracked.
void learn(const SmearTrend& trend, double bloom_px, CameraSmear& smear);

}  // namespace arthronaut::markers
