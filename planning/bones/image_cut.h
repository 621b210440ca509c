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

  // Whether bone is missing there that landmarks, grids and checks are taken to follow from. Less than 1 cm2
  // may be the edge of a bone that only just touches that of the images: then it concerns what is planned
  // there.
  [[nodiscard]] bool is_wide() const { return area_mm2 >= 100; }
  // Whether a ball about a point of the surface reaches what lies beyond.
  [[nodiscard]] bool is_reached(const Eigen::Vector3d& point_mm, double radius_mm = 0) const {
    return out.dot(point_mm - at_mm) > -radius_mm;
  }
  // Finite, its direction a unit one: another would say of every place that the images end there, or of none.
  [[nodiscard]] bool is_sound() const;
  // "the images end within it: 12 cm2 of it are cut off flat in front, ..."
  [[nodiscard]] std::string words() const;
  bool operator==(const ImageCut&) const = default;
};

// Whether any of them is reached.
[[nodiscard]] bool images_end_at(const std::vector<ImageCut>& cuts, const Eigen::Vector3d& point_mm,
                                 double radius_mm = 0);

}  // namespace arthronaut::bones
