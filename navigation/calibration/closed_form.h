// Starts for the joint adjustment, from nothing: the closed form of each picture, then what they have in
// common. Inside the module.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "navigation/calibration/adjustment.h"

namespace arthronaut::calibration {

// Several, the likeliest first: with the closed form's distortion, then with assumed ones for pictures that
// do not hold it (little distortion, boards that face the lens). `turns`: the lens angles are those of the
// marks; a picture without one gets the angle at which its circle stands on its way about the centre.
[[nodiscard]] std::vector<Estimate> closed_form_starts(std::span<const Sighting> sightings,
                                                       const Eigen::Vector2i& size_px, bool turns);

// The point about which these places turn by these angles, by least squares; nullopt when they hardly turn.
[[nodiscard]] std::optional<Eigen::Vector2d> center_of_turning(std::span<const Eigen::Vector2d> places,
                                                               std::span<const double> angles_rad);

// The place that a turn about a centre takes a point to; positive from +x towards +y.
[[nodiscard]] Eigen::Vector2d turned_about(const Eigen::Vector2d& center, const Eigen::Vector2d& point,
                                           double angle_rad);

}  // namespace arthronaut::calibration
