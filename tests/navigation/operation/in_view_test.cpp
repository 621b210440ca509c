// What was in view, and what ends it.
#include "navigation/operation/in_view.h"

#include <gtest/gtest.h>

namespace arthronaut::operation {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(InView, AMarkerThatWasLostForLongIsToldOnceItIsBack) {
  InView in_view;
  EXPECT_FALSE(in_view.add(0, true, false).marker_is_back);
  EXPECT_FALSE(in_view.add(30 * kSecond_ns, true, false).marker_is_back);
  EXPECT_FALSE(in_view.add(50 * kSecond_ns, false, false).marker_is_back);
  EXPECT_FALSE(in_view.add(61 * kSecond_ns, false, false).marker_is_back);
  EXPECT_TRUE(in_view.add(62 * kSecond_ns, true, false).marker_is_back);
  EXPECT_FALSE(in_view.add(63 * kSecond_ns, true, false).marker_is_back) << "once";
}

// Another source has another clock: no time of the one before is compared with its frames.
TEST(InView, WithAnotherSourceNoTimeIsLeft) {
  InView in_view;
  in_view.add(1000 * kSecond_ns, true, true);
  in_view.guided(1000 * kSecond_ns);
  in_view.control_point_set(1000 * kSecond_ns);
  in_view.control_point_held(1000 * kSecond_ns);
  ASSERT_TRUE(in_view.guided_lately(1001 * kSecond_ns));
  ASSERT_FALSE(in_view.control_point_was_set_before(5 * kSecond_ns));
  in_view.on_source();
  EXPECT_FALSE(in_view.guided_lately(1 * kSecond_ns));
  EXPECT_TRUE(in_view.control_point_was_set_before(0)) << "before all of its frames";
  EXPECT_FALSE(in_view.add(2000 * kSecond_ns, true, false).marker_is_back) << "it was not lost in this one";
  EXPECT_FALSE(in_view.control_point_is_old(2000 * kSecond_ns)) << "no guide was seen in it";
}

TEST(InView, AControlPointIsOldBeforeDrillingAlone) {
  InView in_view;
  in_view.control_point_held(10 * kSecond_ns);
  in_view.add(400 * kSecond_ns, true, false);
  EXPECT_FALSE(in_view.control_point_is_old(400 * kSecond_ns));
  EXPECT_TRUE(in_view.add(401 * kSecond_ns, true, true).guide_is_new) << "the guide came: that is news";
  EXPECT_FALSE(in_view.add(402 * kSecond_ns, true, true).guide_is_new);
  EXPECT_TRUE(in_view.control_point_is_old(402 * kSecond_ns));
  in_view.control_point_held(403 * kSecond_ns);
  EXPECT_FALSE(in_view.control_point_is_old(703 * kSecond_ns));
  EXPECT_TRUE(in_view.control_point_is_old(704 * kSecond_ns));
}

TEST(InView, WhatGuidedDidByOneRegistration) {
  InView in_view;
  in_view.guided(5 * kSecond_ns);
  EXPECT_TRUE(in_view.guided_lately(7 * kSecond_ns));
  EXPECT_FALSE(in_view.guided_lately(7 * kSecond_ns + 1));
  in_view.on_registration();
  EXPECT_FALSE(in_view.guided_lately(5 * kSecond_ns));
}

}  // namespace
}  // namespace arthronaut::operation
