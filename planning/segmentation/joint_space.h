// Where the joint space runs in a CT whose femur and tibia touch: in thick slices and worn knees no threshold
// parts them. Inner header of segmentation.
//
// Seen from above, a column of voxels through a condyle passes a bright plate of bone, something darker (the
// cartilages), and another bright plate. How much darker than the less bright plate is the depth of the
// valley there. The joint space is the smooth sheet through the columns with the deepest valleys.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "planning/images/volume.h"

namespace arthronaut::segmentation {

// Height of the sheet over a grid of the patient's left-right and front-back.
struct JointSpace {
  Eigen::Vector2d first_mm;  // LPS x, y of the first column
  double step_mm = 2;
  int columns = 0, rows = 0;
  std::vector<double> height_mm;  // LPS z, columns run fastest
  // Of each column to the nearest where a valley is to be seen; beside them the sheet only goes on.
  std::vector<float> from_seen_mm;
  double area_mm2 = 0;  // over which a valley is to be seen

  struct Sheet {
    double height_mm;
    double from_seen_mm;  // of the furthest of the columns beside it; 0 where it is seen
  };
  // Between the columns; beyond them as at the nearest.
  [[nodiscard]] Sheet at(double x_mm, double y_mm) const;
};

// Within these bounds (LPS, mm). nullopt when less of a joint is seen than a knee has.
[[nodiscard]] std::optional<JointSpace> find_joint_space(const images::Volume& volume,
                                                         const Eigen::Vector3d& low_mm,
                                                         const Eigen::Vector3d& high_mm, double threshold);

}  // namespace arthronaut::segmentation
