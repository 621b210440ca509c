// The camera that explains all pictures, from nothing, though the lens mark be missing or wrong in some.
// Inside the module.
//
// Where two pictures or more show the mark at angles well apart, they fix the centre of rotation; the
// principal point and the round view's centre of any other picture then stand at one place of their way about
// it, which tells that picture's lens angle. A mark that contradicts the rest (something else that looked
// like it) is found by leaving each out in turn.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "navigation/calibration/adjustment.h"

namespace arthronaut::calibration {

// Below this turn the centre of rotation can't be told from the pictures and stays in the middle of the view.
inline constexpr double kLeastMeasurableTurn_deg = 15;

struct JointSolution {
  AdjustmentResult result;  // with covariance; rms_px below 0: no camera explains the pictures
  // As given, has_angle taken from those whose mark is not believed.
  std::vector<Sighting> sightings;
  AdjustmentOptions options;  // that it was made with
};

[[nodiscard]] JointSolution solve_jointly(std::span<const Sighting> sightings,
                                          const Eigen::Vector2i& size_px);

// The widest difference of the mark angles that are known; 0 with fewer than two.
[[nodiscard]] double measured_turn_deg(std::span<const Sighting> sightings);

}  // namespace arthronaut::calibration
