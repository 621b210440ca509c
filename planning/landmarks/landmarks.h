// Named points of a bone, in its frame (LPS, mm), by the field's terms.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

namespace arthronaut::landmarks {

// Names in use. Femur: "native_footprint", "medial_epicondyle", "lateral_epicondyle", "notch_apex",
// "lateral_condyle_posterior", "medial_condyle_posterior", "blumensaat_anterior", "blumensaat_posterior".
// Tibia: "native_footprint", "medial_eminence", "lateral_eminence", "plateau_anterior", "plateau_posterior",
// "plateau_medial", "plateau_lateral", "tuberosity".
using Landmarks = std::map<std::string, Eigen::Vector3d>;

}  // namespace arthronaut::landmarks
