#include "app/plan/visible_bones.h"

#include <gtest/gtest.h>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::plan {
namespace {

using bones::BoneKind;

// Two slabs of bone behind each other, seen along +y: the tibia's front face at y = 0, the femur's at y = 60;
// 30 mm thick.
struct Slabs {
  geometry::Surface tibia{test::box({30, 15, 50}, {0, 15, 0})}, femur{test::box({50, 15, 50}, {0, 75, 0})};
  VisibleBones both{{{BoneKind::Femur, &femur}, {BoneKind::Tibia, &tibia}}};
  VisibleBones femur_alone{{{BoneKind::Femur, &femur}}};
  Eigen::Vector3d eye{0, -200, 0};
  [[nodiscard]] scene::SceneRay towards(const Eigen::Vector3d& point) const {
    return {eye, (point - eye).normalized()};
  }
};

// The mouse meets the bone in front, whichever bone is planned.
TEST(VisibleBones, TheFirstBoneIsMet) {
  const Slabs slabs;
  const auto front = first_visible(slabs.both, slabs.towards({0, 0, 0}));
  ASSERT_TRUE(front);
  EXPECT_EQ(front->bone, BoneKind::Tibia);
  const auto beside = first_visible(slabs.both, slabs.towards({45, 60, 0}));
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->bone, BoneKind::Femur);
  EXPECT_FALSE(first_visible(slabs.both, slabs.towards({90, 60, 0})));
}

// A place within the bone is clicked on through its surface: half way through that bone, not the one behind.
TEST(VisibleBones, TheMiddleOfTheBoneThatIsClicked) {
  const Slabs slabs;
  const scene::SceneRay ray = slabs.towards({6, 0, 9});
  const auto seen = first_visible(slabs.both, ray);
  ASSERT_TRUE(seen);
  const Eigen::Vector3d middle = middle_behind(slabs.tibia, *seen, ray);
  EXPECT_NEAR(middle.y(), 15, 1e-6);
  EXPECT_NEAR((middle - ray.origin_mm).cross(ray.direction).norm(), 0, 1e-9) << "on the ray";
}

// A handle behind a bone, or on the far side of its own, is hidden; one on the near side is not, though it
// lies on the bone.
TEST(VisibleBones, WhatIsBehindBoneIsHidden) {
  const Slabs slabs;
  EXPECT_TRUE(is_hidden(slabs.both, slabs.eye, {0, 60, 0}));
  EXPECT_FALSE(is_hidden(slabs.femur_alone, slabs.eye, {0, 60, 0}));
  EXPECT_TRUE(is_hidden(slabs.femur_alone, slabs.eye, {0, 90, 0}));
  EXPECT_FALSE(is_hidden(slabs.femur_alone, slabs.eye, {70, 90, 0}));
}

// What is cut away neither hides nor is met; the section does both, and says that it is none of the surface.
TEST(VisibleBones, TheCutOpensTheWay) {
  Slabs slabs;
  slabs.both.cut = scene::CutPlane{{0, 45, 0}, {0, -1, 0}};
  const auto behind = first_visible(slabs.both, slabs.towards({0, 60, 0}));
  ASSERT_TRUE(behind);
  EXPECT_EQ(behind->bone, BoneKind::Femur);
  EXPECT_FALSE(behind->is_section);
  EXPECT_FALSE(is_hidden(slabs.both, slabs.eye, {0, 60, 0}));
  EXPECT_TRUE(is_hidden(slabs.both, slabs.eye, {0, 0, 0})) << "it is cut away itself";
  slabs.both.cut = scene::CutPlane{{0, 75, 0}, {0, -1, 0}};
  const auto section = first_visible(slabs.both, slabs.towards({0, 75, 0}));
  ASSERT_TRUE(section);
  EXPECT_TRUE(section->is_section);
  EXPECT_NEAR(section->point_mm.y(), 75, 1e-9);
  EXPECT_TRUE(is_hidden(slabs.both, slabs.eye, {0, 90, 0}));
}

// A drag stays on its piece of surface: over the edge of the slab in front it does not jump 60 mm to the one
// behind, nor through the bone to its far side.
TEST(VisibleBones, ADragDoesNotJump) {
  const Slabs slabs;
  const Eigen::Vector3d entry(28, 0, 0);
  const auto along = dragged_over(slabs.both, BoneKind::Tibia, entry, slabs.towards({29, 0, 1}), false);
  ASSERT_TRUE(along);
  EXPECT_NEAR((*along - Eigen::Vector3d(29, 0, 1)).norm(), 0, 1e-9);
  EXPECT_FALSE(dragged_over(slabs.both, BoneKind::Tibia, entry, slabs.towards({31, 0, 0}), false))
      << "the other bone";
  EXPECT_FALSE(dragged_over(slabs.femur_alone, BoneKind::Femur, {0, 90, 0}, slabs.towards({1, 60, 0}), false))
      << "from the far side to the near one";
  const auto through =
      dragged_over(slabs.femur_alone, BoneKind::Femur, {0, 90, 0}, slabs.towards({1, 90, 0}), true);
  ASSERT_TRUE(through);
  EXPECT_NEAR((*through - Eigen::Vector3d(1, 90, 0)).norm(), 0, 1e-9);
}

}  // namespace
}  // namespace arthronaut::plan
