#include "navigation/contour/agreement.h"

#include <gtest/gtest.h>

namespace arthronaut::contour {
namespace {

constexpr double kPicture_s = 1.0 / 30;
constexpr std::size_t kPieces = 20;

ShiftMap piece_that_is(double alike, bool is_as_clear = true) {
  ShiftMap map;
  map.in_place = static_cast<float>(alike);
  map.is_as_clear = is_as_clear;
  return map;
}

// The first `count` pieces alike, the others not.
void see(Agreement& agreement, double seconds, std::size_t count, bool learns = false,
         bool rest_is_as_clear = true) {
  for (double t = 0; t < seconds; t += kPicture_s) {
    for (std::size_t i = 0; i < kPieces; ++i)
      agreement.add(i, i < count ? piece_that_is(0.8) : piece_that_is(0.2, rest_is_as_clear), learns);
    (void)agreement.judge(kPicture_s);
  }
}

Agreement learnt() {
  Agreement agreement(kPieces);
  see(agreement, 1, kPieces, true);
  return agreement;
}

TEST(Agreement, SaysNothingBeforeItKnowsHowAlikePiecesAre) {
  Agreement agreement(kPieces);
  see(agreement, 1, 0, false);
  EXPECT_FALSE(agreement.verdict().is_asked);
  EXPECT_FALSE(agreement.verdict().is_otherwise);
}

TEST(Agreement, TellsAnotherSurfaceWithinASecondAndForgivesItSlowly) {
  Agreement agreement = learnt();
  EXPECT_TRUE(agreement.verdict().agrees);
  see(agreement, 0.3, 0);
  EXPECT_FALSE(agreement.verdict().is_otherwise) << "a moment is none";
  see(agreement, 0.7, 0);
  EXPECT_TRUE(agreement.verdict().is_otherwise);
  see(agreement, 0.6, kPieces);
  EXPECT_TRUE(agreement.verdict().is_otherwise);
  see(agreement, 0.8, kPieces);
  EXPECT_FALSE(agreement.verdict().is_otherwise);
}

TEST(Agreement, AThirdOfThePiecesHiddenIsNoOtherSurface) {
  Agreement agreement = learnt();
  see(agreement, 3, kPieces * 2 / 3);
  EXPECT_FALSE(agreement.verdict().is_otherwise);
}

// A film over all but a few: fewer pieces, not other ones.
TEST(Agreement, WhatIsNotSeenClearlyIsNotAsked) {
  Agreement agreement = learnt();
  see(agreement, 3, 0, false, false);
  EXPECT_FALSE(agreement.verdict().is_asked);
  EXPECT_FALSE(agreement.verdict().is_otherwise);
}

TEST(Agreement, ForgetsWithTheRegistration) {
  Agreement agreement = learnt();
  see(agreement, 1, 0);
  ASSERT_TRUE(agreement.verdict().is_otherwise);
  agreement.clear();
  EXPECT_FALSE(agreement.verdict().is_otherwise);
  see(agreement, 1, 0);
  EXPECT_FALSE(agreement.verdict().is_asked);
}

}  // namespace
}  // namespace arthronaut::contour
