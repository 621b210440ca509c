// Whether bone lies beneath all of a surface that was grown or painted: a leak into muscle or fat looks like
// a hump of bone, and its shape alone may pass for one.
//
// In a CT: within 3 mm beneath the surface there is something as dense as bone. In an MR: 2 to 4 mm beneath
// it the grey is that of the marrow beneath the rest of the surface, but for a field that is brighter on one
// side (a plane through the values, fitted without those that do not belong). Fat is as bright as marrow in
// most sequences: where more than a tenth of the surroundings is, no leak that is not seen is ruled out.
// Where the images cut the bone off, or the painting ends it flat, nothing is asked.
#pragma once

#include <string>

#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::segmentation {

struct BoneBeneath {
  enum class Outcome { NotChecked, Everywhere, NotEverywhere } outcome = Outcome::NotChecked;
  double area_cm2 = 0;                                  // of the largest patch without bone beneath
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  // of that patch; LPS
  // NotChecked: why; NotEverywhere: where that is, as "behind, below". For a person.
  std::string reason = "bone_beneath was not called";
};

// A patch of this area and more is told.
inline constexpr double kLeastLeak_cm2 = 2.0;

// The surface is closed and turned outwards, LPS, mm; images: that it was painted in. Milliseconds.
[[nodiscard]] BoneBeneath bone_beneath(const geometry::TriangleMesh& surface, const images::Volume& images);

}  // namespace arthronaut::segmentation
