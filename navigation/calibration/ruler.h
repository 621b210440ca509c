// A ruler with two markers of one size at a known pose to each other.
#pragma once

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::calibration {

struct Ruler {
  int first_id = 5, second_id = 6;
  double size_mm = 2.89;
  geometry::RigidTransform first_from_second{Eigen::Quaterniond::Identity(), {10, 0, 0}};
};

}  // namespace arthronaut::calibration
