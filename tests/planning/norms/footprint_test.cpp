#include "planning/norms/footprint.h"

#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::norms {
namespace {

using bones::BoneKind;
using bones::Side;

TEST(InsertionNorms, EveryBundleOfEveryBoneHasADefaultWithASource) {
  for (const auto bone : {BoneKind::Femur, BoneKind::Tibia}) {
    for (const auto bundle : {Bundle::Whole, Bundle::Anteromedial, Bundle::Posterolateral}) {
      const auto& norm = default_norm(bone, bundle);
      EXPECT_EQ(norm.bone, bone);
      EXPECT_EQ(norm.bundle, bundle);
      EXPECT_FALSE(norm.source.empty());
      EXPECT_GT(norm.along.sd, 0);
      EXPECT_EQ(bundle_from_text(to_text(bundle)), bundle);
    }
  }
  EXPECT_THROW((void)bundle_from_text("whole"), InvalidInput);
}

// The phantom's insertions were put at 28 and 35 % (femur) and 41 and 47 % (tibia) of the grid of its
// landmarks: a norm of that place finds them. On the tibia the phantom looks along its z, the grid along the
// long axis that the edges tell.
TEST(ExpectedFootprint, LiesWhereThePhantomsInsertionIs) {
  for (const Side side : {Side::Left, Side::Right}) {
    const auto knee = phantom::make_phantom_knee({.side = side, .edge_length_mm = 1.5});
    const InsertionNorm femoral{BoneKind::Femur, Bundle::Whole, {28, 5}, {35, 7}, "phantom"};
    const geometry::Surface femur(knee.femur.mesh);
    const auto on_femur =
        expected_footprint(knee.femur.mesh, femur, BoneKind::Femur, side, knee.femur_landmarks, femoral);
    ASSERT_TRUE(on_femur);
    EXPECT_LT((on_femur->center_mm - knee.femur_landmarks.at("native_footprint")).norm(), 0.05);
    const InsertionNorm tibial{BoneKind::Tibia, Bundle::Whole, {41, 3}, {47, 2}, "phantom"};
    const geometry::Surface tibia(knee.tibia.mesh);
    const auto on_tibia =
        expected_footprint(knee.tibia.mesh, tibia, BoneKind::Tibia, side, knee.tibia_landmarks, tibial);
    ASSERT_TRUE(on_tibia);
    EXPECT_LT((on_tibia->center_mm - knee.tibia_landmarks.at("native_footprint")).norm(), 1.5);
    for (const auto* footprint : {&*on_femur, &*on_tibia}) {
      const auto& surface = footprint == &*on_femur ? femur : tibia;
      for (const auto* line : {&footprint->outline_mm, &footprint->spread_mm}) {
        ASSERT_EQ(line->size(), 48u);
        for (const auto& p : *line) EXPECT_LT((surface.closest_point(p).point_mm - p).norm(), 1e-6);
      }
      // About the published 9 by 16 to 18 mm: on the bone no point is nearer than 3 or further than 15 mm.
      for (const auto& p : footprint->outline_mm) {
        EXPECT_GT((p - footprint->center_mm).norm(), 3.0);
        EXPECT_LT((p - footprint->center_mm).norm(), 15.0);
      }
    }
  }
}

TEST(ExpectedFootprint, IsNotThereWithoutAGrid) {
  const auto knee = phantom::make_phantom_knee({.edge_length_mm = 2});
  const geometry::Surface femur(knee.femur.mesh);
  EXPECT_FALSE(expected_footprint(knee.femur.mesh, femur, BoneKind::Femur, Side::Right, {},
                                  default_norm(BoneKind::Femur, Bundle::Whole)));
}

}  // namespace
}  // namespace arthronaut::norms
