// Finds where several markers of one body lie on it, from poses of them while the body was waved before the
// scope: all frames in which two or more are seen, together. What is sought are the markers' places and the
// body's pose in every frame, so that the corners of all markers come to lie where their own poses have them;
// corners count alike, as a camera of 600 px focal length without distortion would show them, and a marker's
// pose that is far off counts little (Cauchy). Levenberg-Marquardt by Ceres.
//
// The mean of relative poses is worse: each tilt that one marker alone tells badly goes into it in full
// (docs/benchmarks.md holds both beside each other).
//
// Errors of neighbouring frames are alike, so they are taken together, half a second each, where it is
// reckoned how large the standard deviations are ("sandwich" estimator; Liang and Zeger 1986). What a tracker
// does wrong in the same way throughout, no residual shows.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tools {

struct RigSighting {
  std::int64_t frame = 0;
  double time_s = 0;
  int marker_id = 0;
  geometry::RigidTransform camera_from_marker;
};

struct RigOptions {
  std::vector<std::pair<int, double>> markers;  // id and size_mm of each marker of the body
  std::optional<int> reference_id;              // whose frame the places are in; empty: the first
  // Frames in which two markers are seen, before these are taken to be seen together.
  int min_shared_frames = 10;
  // Views from directions (in the body's frame) that differ by more than min_step_deg count as distinct.
  double min_step_deg = 3;
  int min_distinct_views = 20;
  double min_cone_deg = 12;    // half-angle that holds 90 % of those directions, about their mean
  double max_rms_mm = 0.15;    // of the inliers' corners, across the line of sight
  double max_sigma_mm = 0.03;  // one sigma of each coordinate of a place, the largest
  double max_sigma_deg = 0.2;
  double min_inlier_share = 0.7;
  // Before and after a moment of the wave, at three moments: a place that differs by more than this and by
  // more than five sigma has moved.
  double max_change_mm = 0.12, max_change_deg = 0.5;
};

struct RigSummary {
  enum class Outcome {
    NotRun,
    TooFewMarkers,  // fewer than two of the body's are ever seen
    NeverTogether,  // a marker is not seen with the others in enough frames
    NoSolution,     // the poses fit no rigid body
    TooManyOutliers,
    TooFewViews,  // distinct views or cone
    MarkerMoved,
    ResidualTooLarge,
    PlacesUncertain,
    Ok,
  } outcome = Outcome::NotRun;
  std::string message = "calibrate_rig was not called.";
  std::vector<std::string> reasons;  // every limit that is broken, in plain words; empty when Ok

  struct Place {
    int marker_id = 0;
    double size_mm = 0;
    geometry::RigidTransform reference_from_marker;
    // Of the twist on the marker's side (v mm, w rad), by the residuals alone; zero for the reference.
    geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
    // The largest of a coordinate, and about an axis, with what residuals do not show: for tools.json.
    double sigma_mm = 0, sigma_deg = 0;
    int frame_count = 0;  // in which it was seen with another
  };
  // Meaningful when has_places(); to be used only when is_usable(). In the order of the options.
  std::vector<Place> places;
  double rms_mm = -1;  // of the inliers' corners, across the line of sight
  double cone_deg = 0;
  int frame_count = 0, distinct_views = 0;  // frames with two or more markers
  int sighting_count = 0, inlier_count = 0;
  // The largest that a place changed in the wave, and whose; -1: none.
  double change_mm = 0, change_deg = 0;
  int changed_id = -1;

  [[nodiscard]] bool has_places() const { return outcome > Outcome::NoSolution; }
  [[nodiscard]] bool is_usable() const { return outcome == Outcome::Ok; }
};

// Sightings in the order of frames; those of other markers are passed over. Never throws on poor data: read
// the summary. Throws InvalidInput when an option is out of range: fewer than two markers, one declared
// twice, a size or a limit that is not above 0, a reference that is none of them.
[[nodiscard]] RigSummary calibrate_rig(std::span<const RigSighting> sightings, const RigOptions& options);

}  // namespace arthronaut::tools
