// The sheet of a joint whose course is known.
#include "planning/segmentation/joint_space.h"

#include <gtest/gtest.h>

#include "planning/segmentation/joint_parting.h"

namespace arthronaut::segmentation {
namespace {

// Two blocks of bone with plates, dark between them, seen over 64 by 48 mm; over the patch the space lies
// lower.
constexpr int kWidth = 64, kDepth = 48, kHeight = 60;
constexpr double kLevel_mm = 30, kHigher_mm = 34;
bool is_patch(int x, int y) { return x >= 40 && x < 56 && y >= 16 && y < 32; }

images::Volume stepped_joint() {
  images::Volume volume;
  volume.size = {kWidth, kDepth, kHeight};
  for (int z = 0; z < kHeight; ++z)
    for (int y = 0; y < kDepth; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const double off_mm = std::abs(z - (is_patch(x, y) ? kHigher_mm : kLevel_mm));
        volume.values.push_back(off_mm < 1 ? 250.0F : off_mm < 4 ? 420.0F : 300.0F);
      }
  return volume;
}

// In one compartment the space lies a step higher than in most of the joint, as in a knee that leans in thick
// slices: no line of columns leaves the level alone, and the bone between the two heights went with the
// tibia.
TEST(JointSpace, FollowsAStepThatNoSingleLineWouldTake) {
  const images::Volume volume = stepped_joint();
  const auto joint = find_joint_space(volume, Eigen::Vector3d::Zero(),
                                      Eigen::Vector3d(kWidth - 1, kDepth - 1, kHeight - 1), 180);
  ASSERT_TRUE(joint);
  for (int y = 4; y < kDepth - 4; y += 4)
    for (int x = 4; x < kWidth - 4; x += 4) {
      const JointSpace::Sheet sheet = joint->at(x, y);
      const bool is_inner = is_patch(x - 3, y - 3) && is_patch(x + 3, y + 3);
      const bool is_outer = !is_patch(x - 3, y - 3) && !is_patch(x + 3, y + 3) && !is_patch(x - 3, y + 3) &&
                            !is_patch(x + 3, y - 3);
      if (!is_inner && !is_outer) continue;  // the step itself
      EXPECT_NEAR(sheet.height_mm, is_inner ? kHigher_mm : kLevel_mm, 1) << x << ", " << y;
      EXPECT_EQ(sheet.from_seen_mm, 0) << x << ", " << y;
    }
}

// What was parted beside the space is told: of a sheet that is right nothing; of one that passes through
// bone, and says itself that it sees nothing there, more than the square centimetre from which on an import
// is doubted.
TEST(JointParting, TellsWhatIsCutBesideTheSpace) {
  const images::Volume volume = stepped_joint();
  const auto joint = find_joint_space(volume, Eigen::Vector3d::Zero(),
                                      Eigen::Vector3d(kWidth - 1, kDepth - 1, kHeight - 1), 180);
  ASSERT_TRUE(joint);
  BoneSolid whole{{Eigen::Vector3i::Zero(), volume.size}, images::VoxelMask(volume.size)};
  whole.mask.inside.assign(whole.mask.inside.size(), 1);
  const PartedBones parted = part_bones(volume, whole, *joint, 180, 0);
  EXPECT_EQ(parted.off_joint_mm2, 0);
  JointSpace wrong = *joint;
  for (double& height : wrong.height_mm) height += 6;  // through the bone above, and told to be unseen there
  for (float& from_seen : wrong.from_seen_mm) from_seen = 20;
  EXPECT_GT(part_bones(volume, whole, wrong, 180, 0).off_joint_mm2, 100);
}

}  // namespace
}  // namespace arthronaut::segmentation
