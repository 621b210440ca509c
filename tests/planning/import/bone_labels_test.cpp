// Which labels are which bones, by shape: the built-in knee as a label map with numbers that say nothing.
#include "planning/import/bone_labels.h"

#include <gtest/gtest.h>

#include "tests/planning/segmentation/known_mr.h"

namespace arthronaut::importing {
namespace {

using bones::BoneKind;

images::Volume knee(float femur, float tibia) {
  images::Volume volume = test::known_labels();
  for (float& value : volume.values) value = value == 5 ? femur : value == 6 ? tibia : value;
  return volume;
}

TEST(BoneLabels, FemurAndTibiaAreToldByTheirShapesWhateverTheirNumbers) {
  for (const auto& [femur, tibia] : {std::pair{2, 9}, std::pair{9, 2}}) {
    std::vector<std::string> lines;
    const auto found = labels_by_shape(knee(static_cast<float>(femur), static_cast<float>(tibia)), lines);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found.at(BoneKind::Femur), femur);
    EXPECT_EQ(found.at(BoneKind::Tibia), tibia);
    EXPECT_EQ(lines.size(), 1U) << "it is said";
  }
}

// A block of muscle beside them is neither; two bones under one number, or one that is upside down, are for a
// person to tell.
TEST(BoneLabels, NothingIsTakenForABoneThatIsNone) {
  images::Volume volume = knee(1, 2);
  for (int k = 10; k < volume.size.z() - 10; ++k)
    for (int j = 0; j < volume.size.y() / 8; ++j)
      for (int i = 0; i < volume.size.x(); ++i)
        if (float& value = volume.values[volume.index(i, j, k)]; value == 0) value = 3;
  std::vector<std::string> lines;
  const auto found = labels_by_shape(volume, lines);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found.at(BoneKind::Femur), 1);
  EXPECT_TRUE(labels_by_shape(knee(4, 4), lines).empty());
  images::Volume upside_down = knee(1, 2);
  upside_down.lps_from_index.matrix().middleRows<2>(1) *= -1;  // turned about the left-right axis
  EXPECT_TRUE(labels_by_shape(upside_down, lines).empty());
  EXPECT_EQ(lines.size(), 1U) << "of what is not told nothing is said";
}

}  // namespace
}  // namespace arthronaut::importing
