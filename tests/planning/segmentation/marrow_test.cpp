// Marrow behind a gap of the cortex.
#include "planning/segmentation/marrow.h"

#include <gtest/gtest.h>

namespace arthronaut::segmentation {
namespace {

constexpr double kThreshold_hu = 180;
constexpr int kSize = 60, kFirst = 12, kLast = 48;  // of the volume; of a hollow box of bone, 37 mm wide

struct HollowBox {
  images::Volume volume;
  BoneSolid solid;
  std::size_t middle = 0;
};
// Its lid has a window of 25 by 25 mm, wider than any gap that is closed, filled with `window_hu`.
HollowBox hollow_box(float window_hu) {
  HollowBox box;
  box.volume.size = Eigen::Vector3i::Constant(kSize);
  box.solid = {{Eigen::Vector3i::Zero(), box.volume.size}, images::VoxelMask(box.volume.size)};
  const auto is_in = [](int c) { return c >= kFirst && c <= kLast; };
  for (int z = 0; z < kSize; ++z)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const bool is_in_box = is_in(x) && is_in(y) && is_in(z);
        const bool is_inner = x > kFirst + 1 && x < kLast - 1 && y > kFirst + 1 && y < kLast - 1 &&
                              z > kFirst + 1 && z < kLast - 1;
        const bool is_window =
            is_in_box && z >= kLast - 1 && std::abs(x - 30) <= 12 && std::abs(y - 30) <= 12;
        const bool is_shell = is_in_box && !is_inner && !is_window;
        box.volume.values.push_back(is_shell ? 600.0F : is_window ? window_hu : is_in_box ? -20.0F : 50.0F);
        box.solid.mask.inside[box.solid.mask.index(x, y, z)] = is_shell;
      }
  // The volume goes on about the box that the solid lies in.
  box.solid.box.first = Eigen::Vector3i::Constant(2);
  box.solid.box.size = Eigen::Vector3i::Constant(kSize - 4);
  images::VoxelMask inner(box.solid.box.size);
  for (std::size_t v = 0; v < inner.inside.size(); ++v) {
    const Eigen::Vector3i at = inner.index_of(v) + box.solid.box.first;
    inner.inside[v] = box.solid.mask.inside[box.solid.mask.index(at.x(), at.y(), at.z())];
  }
  box.solid.mask = inner;
  box.middle = inner.index(28, 28, 28);
  return box;
}

// A plate thinner than a slice is darker than the threshold over more than any gap that is closed, and no
// soft tissue all the same: without it the inside of the cortex was the surface of the bone.
TEST(Marrow, IsClosedOffBehindAPlateTooDimForTheThreshold) {
  HollowBox box = hollow_box(140);
  const images::VoxelMask none(box.solid.mask.size);
  const ClosedMarrow closed = close_marrow(box.volume, box.solid, none, kThreshold_hu);
  EXPECT_TRUE(closed.has_dim_walls);
  EXPECT_TRUE(box.solid.mask.inside[box.middle]);
  // The window's own two voxels are bone but for the outer one at most; nothing beyond them is.
  EXPECT_TRUE(box.solid.mask.inside[box.solid.mask.index(28, 28, kLast - 1 - 2)]);
  EXPECT_FALSE(box.solid.mask.inside[box.solid.mask.index(28, 28, kLast + 2 - 2)]);
}

// Muscle does not close it, and neither does what belongs to another bone.
TEST(Marrow, StaysOpenBehindSoftTissueAndBehindAnotherBone) {
  HollowBox box = hollow_box(60);
  EXPECT_EQ(
      close_marrow(box.volume, box.solid, images::VoxelMask(box.solid.mask.size), kThreshold_hu).widest_mm,
      0);
  EXPECT_FALSE(box.solid.mask.inside[box.middle]);

  HollowBox facing = hollow_box(-20);  // open, and another bone over the window
  images::VoxelMask others(facing.solid.mask.size);
  for (int x = 10; x <= 46; ++x)
    for (int y = 10; y <= 46; ++y) {
      const Eigen::Vector3i at(x, y, kLast + 4 - 2);
      others.inside[others.index(at.x(), at.y(), at.z())] = 1;
      facing.volume.values[facing.volume.index(at.x() + 2, at.y() + 2, at.z() + 2)] = 600;
    }
  (void)close_marrow(facing.volume, facing.solid, others, kThreshold_hu);
  EXPECT_FALSE(facing.solid.mask.inside[facing.middle]);
}

}  // namespace
}  // namespace arthronaut::segmentation
