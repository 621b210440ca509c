// Measures where the edges of a marker lie in the raw frame: one profile across each edge sample of a
// predicted pose, matched with the image of the four cells it crosses. Each profile has its own dark and
// bright level, so that light that falls off, shines through or is mirrored in one place does not shift the
// others.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/linear_image.h"
#include "navigation/markers/marker_pattern.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {

// What smears the picture of one marker.
struct Smear {
  double sigma_px = 1.2;  // optics
  // Motion of the marker over the exposure, as a body twist (v mm, w rad).
  geometry::Vector6d motion = geometry::Vector6d::Zero();
  // The same over the time between frames, where its direction is known, too; else zero.
  geometry::Vector6d interval_motion = geometry::Vector6d::Zero();
  // From the field of the even rows to that of the odd ones, in the time between frames; 0: no fields. Each
  // is looked at where the marker was at its time.
  double between_fields = 0;
};

enum class EdgeState {
  Found,
  OutOfView,
  Saturated,  // too many of its pixels are white to the limit
  Flat,       // no contrast
  Different,  // something else is there
};

struct EdgeMeasurement {
  EdgeState state = EdgeState::OutOfView;
  int sample = 0;            // index into the pattern's samples
  Eigen::Vector2d point_px;  // where the pose predicts the edge
  Eigen::Vector2d normal;    // unit, in the image, along the sample's axis
  double offset_px = 0;      // the edge lies at point_px + offset_px * normal
  double sigma_px = 0;       // one-sigma of the offset
  double contrast = 0;       // bright less dark level, in light
  double box_px = 0;         // length of the smear across the edge
  double likeness = 0;       // correlation of profile and model
  double moves_px = 0;       // along the normal, in the time between frames
  double row_share = 0;      // of all rows, how many its row is after the marker's centre (row_timing.h)
  // What a unit of the delays of row_timing.h moves it by, along the normal.
  Eigen::Vector2d by_delays_px = Eigen::Vector2d::Zero();
};

struct ProfileOptions {
  int search_px = 0;  // whole-pixel shifts to try to either side before the fine match
  int stride = 1;     // use every so many samples
};

// How the residuals of a marker's profiles want the smear changed; from the fine match.
struct SmearTrend {
  double sigma_gain = 0, sigma_weight = 0;  // step = gain / weight
  // The same for the motion over the exposure as a vector in the image: step = weight^-1 gain, in pixels.
  Eigen::Vector2d motion_gain = Eigen::Vector2d::Zero();
  Eigen::Matrix2d motion_weight = Eigen::Matrix2d::Zero();
};

// One measurement for each sample used; `measurements` keeps its memory. A pose that is partly behind the
// camera gives OutOfView there.
void measure_edges(const LinearImage& image, const camera::CameraModel& camera,
                   const geometry::RigidTransform& camera_from_marker, double size_mm, int cells,
                   std::span<const EdgeSample> samples, const Smear& smear, const ProfileOptions& options,
                   std::vector<EdgeMeasurement>& measurements, SmearTrend& trend);

}  // namespace arthronaut::markers
