// Landmarks of a case against those that the bone's shape gives: a slip of the hand is as confirmed as what
// is right.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "planning/landmarks/landmarks.h"
#include "planning/landmarks/propose.h"

namespace arthronaut::landmarks {

// How far a landmark lies from where the shape puts it: with either convention of Blumensaat's line, the
// nearer place counts. Of the line's posterior end what lies across the line: the grid's depth is the
// condyle's, this end gives a direction alone, and how far back the roof is followed is a matter of taste.
// nullopt where the shape gives none of this name.
[[nodiscard]] std::optional<double> off_shape_mm(const std::string& name, const Eigen::Vector3d& at_mm,
                                                 const Proposal& by_shape);

struct OffShape {
  std::string name;
  double off_mm = 0;
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  // the landmark, bone frame
};
// Of all that the shape knows, the furthest first. Empty where nothing is proposed.
[[nodiscard]] std::vector<OffShape> off_shape(const Landmarks& landmarks, const Proposal& by_shape);

}  // namespace arthronaut::landmarks
