#include "app/plan/edge_words.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arthronaut::plan {
namespace {

using Eigen::Vector3d;

// LPS: the patient's left is +x, so that a right knee's lateral side is -x and a left one's +x.
TEST(EdgeWords, TellARightKneeFromALeftOne) {
  const Vector3d right = Vector3d::UnitX(), up = Vector3d::UnitZ();  // looked at from the front
  EXPECT_EQ(edge_words(right, up, landmarks::scanner_axes(bones::Side::Right)),
            (EdgeWords{"lateral", "medial", "proximal", "distal"}));
  EXPECT_EQ(edge_words(right, up, landmarks::scanner_axes(bones::Side::Left)),
            (EdgeWords{"medial", "lateral", "proximal", "distal"}));
}

// Onto the plateau of a right knee from above, its front up.
TEST(EdgeWords, FollowTheBonesAxes) {
  const auto axes = landmarks::scanner_axes(bones::Side::Right);
  EXPECT_EQ(edge_words(axes.lateral, axes.anterior, axes),
            (EdgeWords{"medial", "lateral", "anterior", "posterior"}));
}

// The entry's circle at the upper edge of a tibia's radiograph stood under "proximal".
TEST(EdgeWords, StandInTheMiddleOrBesideWhatIsDrawnThere) {
  constexpr widgets::Rect kLine{100, 50, 400, 300};
  const ImVec2 size{60, 20};
  EXPECT_EQ(middle_place(size, kLine, {}).x, 270);
  EXPECT_EQ(middle_place(size, kLine, {{250, 100, 350, 140}}).x, 270) << "below it";
  const ImVec4 circle{280, 40, 320, 80};
  const ImVec2 beside = middle_place(size, kLine, {circle});
  EXPECT_EQ(beside.y, 50);
  EXPECT_TRUE(beside.x >= circle.z || beside.x + size.x <= circle.x);
  EXPECT_LT(std::abs(beside.x - 270), 60) << "as near to the middle as it can";
  EXPECT_EQ(middle_place(size, kLine, {{100, 40, 500, 80}}).x, 270) << "nothing is free";
}

// Half way between two sides it is neither.
TEST(EdgeWords, NameNoEdgeThatLooksBetweenTwoSides) {
  const auto axes = landmarks::scanner_axes(bones::Side::Right);
  const Vector3d between = (axes.lateral + axes.anterior + 0.5 * axes.proximal).normalized();
  const Vector3d up = (axes.proximal - axes.proximal.dot(between) * between).normalized();
  EXPECT_EQ(edge_words(between, up, axes), (EdgeWords{"", "", "proximal", "distal"}));
}

}  // namespace
}  // namespace arthronaut::plan
