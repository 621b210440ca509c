#include "planning/bones/bone.h"

#include <gtest/gtest.h>

#include "planning/geometry/error.h"

namespace arthronaut::bones {
namespace {

TEST(Bone, WordsRoundTripAndOthersAreRefused) {
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia})
    EXPECT_EQ(bone_kind_from_text(to_text(kind)), kind);
  for (const Side side : {Side::Left, Side::Right}) EXPECT_EQ(side_from_text(to_text(side)), side);
  EXPECT_THROW((void)bone_kind_from_text("Femur"), InvalidInput);
  EXPECT_THROW((void)bone_kind_from_text("patella"), InvalidInput);
  EXPECT_THROW((void)side_from_text("l"), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::bones
