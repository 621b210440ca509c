#include "navigation/registration/online/stroke_set.h"

#include <gtest/gtest.h>

namespace arthronaut::registration {

namespace {

// Straight strokes of 20 mm, side by side.
strokes::Curves straight_strokes(int count) {
  strokes::Curves curves;
  for (int curve = 0; curve < count; ++curve) {
    for (int i = 0; i <= 50; ++i) curves.push_back({curve, 0, Eigen::Vector3d(0.4 * i, 5.0 * curve, 0)});
  }
  return curves;
}

}  // namespace

// Strokes are told apart by their numbers; what is excluded doesn't count but can come back, what is undone
// is gone.
TEST(StrokeSet, CountsWhatIsInUse) {
  StrokeSet strokes;
  EXPECT_FALSE(strokes.undo());
  strokes.add_points(straight_strokes(3));
  EXPECT_EQ(strokes.all().size(), 3u);
  EXPECT_NEAR(strokes.unmeasured_mm(), 60, 1e-9);
  strokes.measure();
  EXPECT_EQ(strokes.unmeasured_mm(), 0);
  EXPECT_NEAR(strokes.length_in_use_mm(), 60, 0.5);
  EXPECT_TRUE(strokes.exclude(1, true));
  EXPECT_FALSE(strokes.exclude(7, true));
  EXPECT_NEAR(strokes.length_in_use_mm(), 40, 0.5);
  EXPECT_EQ(strokes.curves_in_use().size(), 102u);
  const strokes::Curves in_use = strokes.curves_in_use();
  for (const strokes::OrientedPoint& point : strokes.oriented_in_use()) {
    EXPECT_NE(point.curve, 1);
    ASSERT_LT(point.source_index, in_use.size());
    EXPECT_EQ(in_use[point.source_index].curve, point.curve);
  }
  EXPECT_TRUE(strokes.undo());
  EXPECT_TRUE(strokes.exclude(1, false));
  EXPECT_NEAR(strokes.length_in_use_mm(), 40, 0.5);
  strokes.clear();
  EXPECT_TRUE(strokes.curves_in_use().empty());
}

// A stroke that grows is measured again, whole.
TEST(StrokeSet, MeasuresAStrokeThatGrows) {
  const strokes::Curves curve = straight_strokes(1);
  StrokeSet strokes;
  strokes.add_points({curve.data(), 26});
  strokes.measure();
  EXPECT_NEAR(strokes.length_in_use_mm(), 10, 0.5);
  strokes.add_points({curve.data() + 26, 25});
  EXPECT_NEAR(strokes.length_in_use_mm(), 10, 0.5);
  strokes.measure();
  EXPECT_NEAR(strokes.length_in_use_mm(), 20, 0.5);
}

}  // namespace arthronaut::registration
