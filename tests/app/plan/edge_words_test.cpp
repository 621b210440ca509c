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

// Half way between two sides it is neither.
TEST(EdgeWords, NameNoEdgeThatLooksBetweenTwoSides) {
  const auto axes = landmarks::scanner_axes(bones::Side::Right);
  const Vector3d between = (axes.lateral + axes.anterior + 0.5 * axes.proximal).normalized();
  const Vector3d up = (axes.proximal - axes.proximal.dot(between) * between).normalized();
  EXPECT_EQ(edge_words(between, up, axes), (EdgeWords{"", "", "proximal", "distal"}));
}

}  // namespace
}  // namespace arthronaut::plan
