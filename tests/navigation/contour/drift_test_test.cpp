#include "navigation/contour/drift_test.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arthronaut::contour {
namespace {

constexpr double kFrame_s = 1.0 / 30;

// The profile of an edge that stands `off_mm` along a normal.
EdgeProfile edge_at(const Eigen::Vector3d& normal, double off_mm) {
  EdgeProfile profile;
  profile.normal_in_bone = normal.cast<float>();
  float mean = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double away = ((i - kSteps) * kStep_mm - off_mm) / 0.2;
    profile.strength[static_cast<std::size_t>(i)] = static_cast<float>(std::exp(-away * away));
    mean += profile.strength[static_cast<std::size_t>(i)] / kPlaces;
  }
  for (float& strength : profile.strength) strength -= mean;
  return profile;
}

// Edges all around in the plane across z, of a bone that lies `drift` further.
void add_ring(DriftTest& test, const Eigen::Vector3d& drift_mm) {
  for (int i = 0; i < 24; ++i) {
    const double turn = 2 * geometry::kPi * i / 24;
    const Eigen::Vector3d normal(std::cos(turn), std::sin(turn), 0);
    test.add(edge_at(normal, normal.dot(drift_mm)));
  }
}

// Seconds from the drift on until it is told; empty: not within five.
std::optional<double> told_after_s(const Eigen::Vector3d& drift_mm) {
  DriftTest test;
  for (int i = 0; i < 60; ++i) {
    add_ring(test, Eigen::Vector3d::Zero());
    EXPECT_FALSE(test.judge(kFrame_s).has_drifted);
  }
  EXPECT_TRUE(test.verdict().is_checked);
  for (int i = 1; i <= 150; ++i) {
    add_ring(test, drift_mm);
    if (test.judge(kFrame_s).has_drifted) {
      EXPECT_NEAR((test.verdict().offset_in_bone_mm - drift_mm).norm(), 0, 0.3) << "a step of 0.25 mm";
      return i * kFrame_s;
    }
  }
  return std::nullopt;
}

TEST(DriftTest, TellsAMillimetreAcrossTheLineOfSightWithinTwoSeconds) {
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0.7, 0.7, 0)}) {
    const auto after_s = told_after_s(direction.normalized());
    ASSERT_TRUE(after_s);
    EXPECT_LT(*after_s, 2);
  }
}

// A registration is never exact: what it is off by from the beginning, and small changes, are no drift.
TEST(DriftTest, TellsNoDriftOfAThirdOfAMillimetre) {
  EXPECT_FALSE(told_after_s({0.3, 0, 0}));
  EXPECT_FALSE(told_after_s({-0.2, 0.2, 0}));
}

// Along the line of sight nothing changes in the picture: a tie, and no drift; and the share of directions
// says that it would not be seen.
TEST(DriftTest, WhatTheContourCannotSeeIsNoDrift) {
  EXPECT_FALSE(told_after_s({0, 0, 1}));
  DriftTest ring, line;
  for (int i = 0; i < 60; ++i) {
    add_ring(ring, Eigen::Vector3d::Zero());
    for (int k = 0; k < 24; ++k) line.add(edge_at({1, 0, 0}, 0));
    (void)ring.judge(kFrame_s);
    (void)line.judge(kFrame_s);
  }
  EXPECT_LT(line.verdict().share_seen, ring.verdict().share_seen - 0.15);
}

// A piece of surface, seen along z, as it is found again of a bone that lies `drift` further: soft grain.
ShiftMap piece_at(const Eigen::Vector3d& drift_mm, double peak = 0.6) {
  constexpr double kWidth_mm = 0.7;
  ShiftMap map;
  float mean = 0;
  for (int v = 0; v < kShiftSide; ++v) {
    for (int u = 0; u < kShiftSide; ++u) {
      const Eigen::Vector2d off_mm =
          kPieceStep_mm * Eigen::Vector2d(u - kShifts, v - kShifts) - drift_mm.head<2>();
      const auto likeness =
          static_cast<float>(peak * std::exp(-off_mm.squaredNorm() / (2 * kWidth_mm * kWidth_mm)));
      map.likeness[static_cast<std::size_t>(v * kShiftSide + u)] = likeness;
      mean += likeness / (kShiftSide * kShiftSide);
    }
  }
  for (float& likeness : map.likeness) likeness -= mean;
  map.shift_per_mm(0, 0) = map.shift_per_mm(1, 1) = static_cast<float>(1 / kPieceStep_mm);
  return map;
}

// Of a millimetre aslant about half is seen, and many pieces of soft grain lead by little: what they were
// compared with is they themselves, so that little is enough. A third of a millimetre is still none.
TEST(DriftTest, TellsASurfaceThatMovedAslantAndNotAThirdOfAMillimetre) {
  const auto is_told = [](const Eigen::Vector3d& drift_mm) {
    DriftTest test;
    for (int i = 0; i < 120; ++i) {
      for (int k = 0; k < 24; ++k) test.add(piece_at(i < 60 ? Eigen::Vector3d::Zero() : drift_mm));
      const bool has_drifted = test.judge(kFrame_s).has_drifted;
      EXPECT_FALSE(has_drifted && i < 60) << "frame " << i;
      if (has_drifted) return true;
    }
    return false;
  };
  EXPECT_TRUE(is_told({0.55, 0, 0.83}));
  EXPECT_TRUE(is_told({0, -0.55, -0.83}));
  EXPECT_FALSE(is_told({0.35, 0, 0}));
  EXPECT_FALSE(is_told({0, 0.35, 0.9}));
  EXPECT_FALSE(is_told({-0.25, 0.25, 0}));
}

// Under blood no place fits, and the best of them is one by chance.
TEST(DriftTest, WhatFitsNowhereIsNoDrift) {
  DriftTest test;
  for (int i = 0; i < 180; ++i) {
    for (int k = 0; k < 24; ++k)
      test.add(i < 60 ? piece_at(Eigen::Vector3d::Zero()) : piece_at({0.9, 0, 0}, 0.12));
    EXPECT_FALSE(test.judge(kFrame_s).has_drifted) << "frame " << i;
  }
  EXPECT_GT(test.verdict().lead, DriftTestOptions().lead_pieces);
}

TEST(DriftTest, NothingSeenIsNotChecked) {
  DriftTest test;
  for (int i = 0; i < 60; ++i) (void)test.judge(kFrame_s);
  EXPECT_FALSE(test.verdict().is_checked);
  EXPECT_FALSE(test.verdict().has_drifted);
  // What was seen is forgotten again.
  for (int i = 0; i < 60; ++i) {
    add_ring(test, Eigen::Vector3d::Zero());
    (void)test.judge(kFrame_s);
  }
  EXPECT_TRUE(test.verdict().is_checked);
  for (int i = 0; i < 150; ++i) (void)test.judge(kFrame_s);
  EXPECT_FALSE(test.verdict().is_checked);
}

// An edge that happens to stand elsewhere for a moment, a tool that passes, is no drift.
TEST(DriftTest, AMomentElsewhereIsNoDrift) {
  DriftTest test;
  for (int i = 0; i < 300; ++i) {
    add_ring(test, i % 60 < 6 ? Eigen::Vector3d(1, 0, 0) : Eigen::Vector3d::Zero());
    EXPECT_FALSE(test.judge(kFrame_s).has_drifted) << "frame " << i;
  }
}

// From where it stood at first, whatever that was: cartilage that the model lacks moves it all the time.
TEST(DriftTest, IsToldFromItsReference) {
  const Eigen::Vector3d at_first(0.75, 0, 0);
  DriftTest test;
  for (int i = 0; i < 60; ++i) {
    add_ring(test, at_first);
    (void)test.judge(kFrame_s);
  }
  EXPECT_NEAR((test.best_near_mm() - at_first).norm(), 0, 0.3);
  test.set_reference(test.best_near_mm());
  for (int i = 0; i < 150; ++i) {
    add_ring(test, at_first);
    const bool has_drifted = test.judge(kFrame_s).has_drifted;
    EXPECT_FALSE(has_drifted && i > 30) << "frame " << i;
  }
}

}  // namespace
}  // namespace arthronaut::contour
