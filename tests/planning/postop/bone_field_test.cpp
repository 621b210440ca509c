#include "planning/postop/bone_field.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace arthronaut::postop {
namespace {

// Two bones that touch are one piece, and the images end within their shafts: the middle of a joint's end may
// lie anywhere along it. From 10 mm off a pose is found.
TEST(BoneField, AJointMayLieAnywhereAlongAPiece) {
  images::Volume volume;
  volume.size = {30, 30, 120};
  volume.lps_from_index = Eigen::Scaling(2.0, 2.0, 2.0);
  volume.values.assign(30UL * 30 * 120, 50.0F);
  for (int k = 10; k < 110; ++k)
    for (int j = 8; j < 22; ++j)
      for (int i = 8; i < 22; ++i) volume.values[volume.index(i, j, k)] = 900;
  const BoneField field = bone_field(volume, 200).value();
  for (double z_mm = 40; z_mm <= 200; z_mm += 1) {
    const auto off_mm = [&](const Eigen::Vector3d& anchor) {
      return (anchor - Eigen::Vector3d(29, 29, z_mm)).norm();
    };
    double nearest_mm = 1e9;
    for (const Eigen::Vector3d& anchor : field.anchors_mm) nearest_mm = std::min(nearest_mm, off_mm(anchor));
    EXPECT_LE(nearest_mm, 10) << z_mm;
  }
}

}  // namespace
}  // namespace arthronaut::postop
