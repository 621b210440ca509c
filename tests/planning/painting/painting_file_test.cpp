#include "planning/painting/painting_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <random>

#include "planning/geometry/error.h"
#include "planning/images/volume_file.h"
#include "planning/images/volume_writer.h"
#include "tests/message_of.h"
#include "tests/planning/painting/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::painting {
namespace {

using testing::HasSubstr;

class PaintingFile : public ::testing::Test {
 protected:
  PaintingFile() {
    grid_.lps_from_index.linear() =
        Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix() *
        Eigen::Vector3d(0.41, 0.52, 1.3).asDiagonal();
  }
  images::Volume grid_ = test::empty_volume({31, 22, 13}, {1, 1, 1});
  const test::TemporaryFolder folder_;
};

TEST_F(PaintingFile, IsReadBackVoxelByVoxelAndNamesItsParts) {
  EXPECT_FALSE(load_painting(folder_.path(), grid_));
  std::mt19937 random(5);
  SavedPainting painting{Labels(grid_.values.size()), Labels(grid_.values.size())};
  for (auto& label : painting.strokes) label = static_cast<std::uint8_t>(random() % 4);
  for (auto& label : painting.bones) label = static_cast<std::uint8_t>(random() % 3);
  save_painting(folder_.path(), grid_, painting);
  const auto loaded = load_painting(folder_.path(), grid_);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->strokes, painting.strokes);
  EXPECT_EQ(loaded->bones, painting.bones);
  const images::Volume read = images::read_volume(bones_file(folder_.path()));
  ASSERT_EQ(read.segments.size(), 2U);
  EXPECT_EQ(read.segments[0].name, "Femur");
  EXPECT_EQ(read.segments[1].label, kTibia);
  EXPECT_NEAR((read.lps_from_index.matrix() - grid_.lps_from_index.matrix()).norm(), 0, 1e-12);
}

TEST_F(PaintingFile, OfAnotherImageOrBrokenIsRefusedAndStays) {
  save_painting(folder_.path(), grid_, {Labels(grid_.values.size(), 1), Labels(grid_.values.size(), 2)});
  images::Volume other = grid_;
  other.lps_from_index.translation().x() += 1;
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)load_painting(folder_.path(), other); }),
              HasSubstr("another image"));
  images::Volume labels = grid_;
  labels.values.assign(labels.values.size(), 7.0F);
  images::write_volume(strokes_file(folder_.path()), labels);
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)load_painting(folder_.path(), grid_); }),
              HasSubstr("3 surroundings"));
  std::ofstream(bones_file(folder_.path()), std::ios::trunc) << "NRRD0004\ntype: uint8\n";
  EXPECT_THROW((void)load_painting(folder_.path(), grid_), InvalidInput);
}

// More than a chunk of the packing, and of a size that no label map packs well to.
TEST_F(PaintingFile, APackedMapOfNoiseIsWhole) {
  images::Volume grid = test::empty_volume({200, 150, 70}, {1, 1, 1});
  std::mt19937 random(6);
  Labels labels(grid.values.size());
  for (auto& label : labels) label = static_cast<std::uint8_t>(random() % 3);
  save_painting(folder_.path(), grid, {labels, labels});
  EXPECT_EQ(load_painting(folder_.path(), grid)->bones, labels);
}

}  // namespace
}  // namespace arthronaut::painting
