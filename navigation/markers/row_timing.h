// When a camera exposes its rows: all at once, one after the other (a rolling shutter), or every other one
// half a frame later (interlaced). What moves is skewed or combed by it, and a skewed square passes for
// another tilt. The camera does not say which it is; the markers that move do, little by little: their edges
// lie off by their motion, each by the delay of its own row.
//
// Delays are counted in the time between frames, from the row that the marker's centre is in, so that a pose
// is of the moment in which that row was exposed; of two fields, of the moment between them. A delay that is
// known is taken out of what is measured. One that is not is an error of the pose, as large as the motion
// makes it: markers that stand still lose nothing.
#pragma once

#include <Eigen/Core>
#include <span>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/edge_profiles.h"

namespace arthronaut::markers {

// By how much one pose's edges ask for other delays, and what the delays do to the pose.
struct RowTrend {
  Eigen::Vector2d gain = Eigen::Vector2d::Zero();  // step = weight^-1 gain
  Eigen::Matrix2d weight = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 6, 2> twist_by_delays =
      Eigen::Matrix<double, 6, 2>::Zero();  // body twist (v mm, w rad)
  // What a pixel of motion in the time between frames, along the image's x and y, does to it when all of that
  // time is taken to read the rows.
  Eigen::Matrix<double, 6, 2> twist_by_motion = Eigen::Matrix<double, 6, 2>::Zero();
};

// Of the middle of a whole row's exposure after the centre's, in the time between frames.
[[nodiscard]] double row_delay(const Eigen::Vector2d& delays, double row, double centre_row, int height_px);

class RowTiming {
 public:
  // Of the last row after the first, and of the odd rows after the even ones: half a frame, if at all. Zero
  // until it is told from zero, and where it is told as what no camera has: outside 0.15 to 0.95 of a frame.
  [[nodiscard]] Eigen::Vector2d known() const;
  // Of known(): the mean square of what it may be off by.
  [[nodiscard]] Eigen::Matrix2d uncertainty() const;
  // How far a corner may be off since it may be combed, while that is not known, and by a motion that is
  // known roughly, when it is. The marker moves by so much in the time between frames, and so much more than
  // before.
  [[nodiscard]] double comb_px(double moves_px, double change_px) const;
  // From a marker that was tracked with what was known.
  void learn(const RowTrend& trend);

 private:
  // Beforehand: a readout may take up to the whole frame, either way up.
  static constexpr double kReadoutSigma = 0.4, kFieldsSigma = 0.25;

  [[nodiscard]] Eigen::Vector2d sigmas() const;
  Eigen::Vector2d mean_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information_ =
      Eigen::Vector2d(1 / (kReadoutSigma * kReadoutSigma), 1 / (kFieldsSigma * kFieldsSigma)).asDiagonal();
};

// Sets what the delays do to each of the edges that were measured, and takes out a readout that is known.
// Fields that are known were read by themselves (measure_edges) and leave nothing.
void correct_rows(const RowTiming& timing, double centre_row, int height_px, double sigma_px,
                  std::span<EdgeMeasurement> measurements);

}  // namespace arthronaut::markers
