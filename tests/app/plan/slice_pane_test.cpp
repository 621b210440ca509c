#include "app/plan/slice_pane.h"

#include <gtest/gtest.h>

namespace arthronaut::plan {
namespace {

// A slice that a measured line only crosses would show a shadow of it beside its whole length.
TEST(SlicePane, DrawsOfALineThatOnlyCrossesItNoShadow) {
  const scene::SlicePlane axial{{0, 0, 30}, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), 0.5};
  const scene::SlicePlane sagittal{{10, 0, 0}, Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitZ(), 0.5};
  const SliceLine across{{{10, 0, 30}, {80, 0, 31}}, "70.0 mm"};
  EXPECT_TRUE(lies_in(across, axial));
  EXPECT_FALSE(lies_in(across, sagittal)) << "one of its ends alone is there";
  EXPECT_FALSE(lies_in({{{10, 0, 0}, {10, 5, 0}, {13, 9, 0}}, "90.0\u00B0"}, sagittal));
}

// The sagittal pane looks from the left: its sign was the other way round than the coordinate's.
TEST(SlicePane, SaysOnWhichSideASliceLies) {
  const Eigen::Vector3d at_mm(66.14, -64.6, 565.9);
  EXPECT_EQ(place_in_words(-Eigen::Vector3d::UnitX(), at_mm), "L 66.1 mm");
  EXPECT_EQ(place_in_words(Eigen::Vector3d::UnitX(), -at_mm), "R 66.1 mm");
  EXPECT_EQ(place_in_words(Eigen::Vector3d::UnitY(), at_mm), "A 64.6 mm");
  EXPECT_EQ(place_in_words(-Eigen::Vector3d::UnitY(), at_mm), "A 64.6 mm");
  EXPECT_EQ(place_in_words(Eigen::Vector3d::UnitZ(), at_mm), "H 565.9 mm");
}

TEST(SlicePane, SaysTheWindowAsViewersDo) {
  EXPECT_EQ(window_in_words(scene::kBoneWindow), "W 2500 L 480");
  EXPECT_EQ(window_in_words({-40.4, 399.6}), "W 400 L \u221240");
}

}  // namespace
}  // namespace arthronaut::plan
