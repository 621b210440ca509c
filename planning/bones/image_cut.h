// Where the images that a bone was made from end within it: its surface is a flat face there that is none of
// the bone's.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace arthronaut::bones {

struct ImageCut {
  // In the middle of the cut, a little within the edge of the images: what of the surface lies beyond, along
  // `out`, is the face or its rounded rim. The bone's frame, LPS.
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d out = Eigen::Vector3d::UnitZ();  // unit, out of the images
  double area_mm2 = 0;

  // Whether a ball about a point of the surface reaches what lies beyond.
  [[nodiscard]] bool is_reached(const Eigen::Vector3d& point_mm, double radius_mm = 0) const {
    return out.dot(point_mm - at_mm) > -radius_mm;
  }
  // "the images end within it: 12 cm2 of it are cut off flat in front, ..."
  [[nodiscard]] std::string words() const;
  bool operator==(const ImageCut&) const = default;
};

// Whether any of them is reached.
[[nodiscard]] bool images_end_at(const std::vector<ImageCut>& cuts, const Eigen::Vector3d& point_mm,
                                 double radius_mm = 0);

}  // namespace arthronaut::bones
