// What an operation heeds of the bone in the picture, and what ends it. watched_bone_test.cpp has the
// pictures.
#include "navigation/operation/bone_watch.h"

#include <gtest/gtest.h>

namespace arthronaut::operation {
namespace {

Touches touched(bool control_point, int count) {
  Touches touches;
  for (int i = 0; i < count; ++i) touches.add_touch({5.0 * i, 0, 0}, {});
  if (control_point) touches.touch_control_point({1, 2, 3}, {});
  return touches;
}

TEST(BoneWatch, WhatWasToldTakesEffectOnce) {
  BoneWatch watch(nullptr);
  watch.tell(SeenDrift{1.5, 7});
  watch.tell(SeenDrift{2.5, 8});
  const auto drift = watch.take_drift();
  ASSERT_TRUE(drift);
  EXPECT_EQ(drift->drift_mm, 1.5) << "the first one stands";
  EXPECT_FALSE(watch.take_drift());
  watch.tell(SeenLooks{false});
  EXPECT_FALSE(watch.take_looks()) << "it looks as it did, as before";
  watch.tell(SeenLooks{true});
  EXPECT_TRUE(watch.take_looks());
  EXPECT_FALSE(watch.take_looks());
}

TEST(BoneWatch, ADoubtIsOfOneRegistrationAndOneSource) {
  BoneWatch watch(nullptr);
  int judged = 0;
  const auto doubt = [&] {
    watch.begin_doubt(true, 0);
    return watch.doubt().control_point_ends();
  };
  RegistrationInForce in_force{Standing::Stands, {}, {}, false, false};
  const auto lies_at = [&](double x_mm) {
    registration::RegistrationSummary found;
    found.marker_from_bone.translation_mm = {x_mm, 0, 0};
    found.predicted_tre_mm = ++judged;
    in_force.registration = std::make_shared<const registration::RegistrationSummary>(found);
    watch.on_registration(in_force);
  };
  lies_at(1);
  ASSERT_TRUE(doubt());
  lies_at(1);
  EXPECT_TRUE(watch.doubt().holds()) << "judged at another plan it has the bone where it had it";
  lies_at(2);
  EXPECT_FALSE(watch.doubt().holds());
  ASSERT_TRUE(doubt());
  in_force.standing = Standing::InDoubt;
  watch.on_registration(in_force);
  EXPECT_FALSE(watch.doubt().holds()) << "one that does not stand guides nobody";
  ASSERT_TRUE(doubt());
  watch.on_source({640, 480});
  EXPECT_FALSE(watch.doubt().holds());
  ASSERT_TRUE(doubt());
  watch.tell(SeenDrift{1.5, 7});
  watch.tell(SeenLooks{false});
  watch.on_source_end();
  EXPECT_FALSE(watch.doubt().holds());
  EXPECT_FALSE(watch.take_drift()) << "what waited goes with it";
  EXPECT_FALSE(watch.take_looks());
  ASSERT_TRUE(doubt());
  watch.look_anew();
  EXPECT_FALSE(watch.doubt().holds());
}

// One that is set anew was set in doubt: it learns where the bone lies since.
TEST(BoneWatch, AControlPointThatIsGoneEndsNoDoubt) {
  BoneWatch watch(nullptr);
  watch.begin_doubt(true, 2);
  watch.on_touches(touched(true, 2));
  EXPECT_TRUE(watch.doubt().control_point_ends());
  EXPECT_EQ(watch.doubt().places_to_touch(touched(true, 2)), 0);
  watch.on_touches(touched(false, 0));
  watch.on_touches(touched(true, 1));
  EXPECT_TRUE(watch.doubt().holds());
  EXPECT_FALSE(watch.doubt().control_point_ends());
  EXPECT_EQ(watch.doubt().places_to_touch(touched(true, 1)), 2) << "those that were there then are gone";
}

// What began the first doubt may have moved the bone before the control point was set.
TEST(PlaceDoubt, AControlPointThatWasSetInDoubtEndsNoSecondOne) {
  PlaceDoubt doubt;
  doubt.begin(false, 0);
  EXPECT_EQ(doubt.places_to_touch(touched(true, 2)), 1);
  doubt.begin(true, 2);
  EXPECT_FALSE(doubt.control_point_ends());
  EXPECT_EQ(doubt.places_to_touch(touched(true, 2)), 3) << "it may have moved since these";
  doubt.end();
  doubt.begin(true, 3);
  EXPECT_TRUE(doubt.control_point_ends());
}

}  // namespace
}  // namespace arthronaut::operation
