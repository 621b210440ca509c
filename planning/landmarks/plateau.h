// The tibial plateau seen from above. Inner header of landmarks.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "planning/geometry/surface.h"
#include "planning/landmarks/rough_frame.h"
#include "planning/landmarks/shape_samples.h"

namespace arthronaut::landmarks {

// Heights over the plateau's plane on a square raster in the frame's x and y about the origin; what is more
// than 30 mm below, or no bone, is empty.
struct Relief {
  static constexpr int kHalf = 40;  // cells to either side
  static constexpr double kCell_mm = 1.25;
  std::vector<double> height_mm;  // kEmpty where there is none
  static constexpr double kEmpty = -1e9;
  [[nodiscard]] double at(int column, int row) const {
    return height_mm[static_cast<std::size_t>((row + kHalf) * (2 * kHalf + 1) + column + kHalf)];
  }
};

struct Plateau {
  Eigen::Matrix3d bone_from_frame =
      Eigen::Matrix3d::Identity();  // x right, y anterior, z out of the plateau's plane
  Eigen::Vector3d origin_mm;        // on the plane, between the middles of both halves
  Relief relief;
  // Of the halves on the -x and the +x side: middle in x and y of the frame, area and front-to-back length.
  Eigen::Vector2d middle_minus, middle_plus;
  double area_minus_mm2 = 0, area_plus_mm2 = 0;
};

// The plane is the one through the two halves, without the eminences between them and the rim; x runs through
// the middles of the halves (Cobb 2008). nullopt where no two halves of 250 mm^2 or more are.
[[nodiscard]] std::optional<Plateau> find_plateau(const geometry::Surface& tibia, const RoughFrame& rough);

}  // namespace arthronaut::landmarks
