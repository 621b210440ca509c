#include "planning/tunnels/breach.h"

#include <gtest/gtest.h>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::tunnels {
namespace {

using Eigen::Vector2d;

// What a planner may rely on.
constexpr double kEnds_mm = 0.02;

// Of a tunnel straight up through a bone of this profile (y, z), 80 mm wide.
std::vector<DepthRange> breaches_in(const std::vector<Vector2d>& profile_mm, double diameter_mm = 9) {
  const geometry::Surface bone(test::prism(profile_mm, 40, {-10, 10}));
  const Tunnel tunnel{.entry_mm = {0, 0, 0}, .direction = {0, 0, 1}, .diameter_mm = diameter_mm};
  return breaches_of(tunnel, measure(tunnel, bone), bone);
}

// The bone draws back to 2.75 mm from the axis at a depth of 3 mm, then swells again.
const std::vector<Vector2d> kUndercut{{5.5, 0}, {2.75, 3}, {25, 30}, {-40, 30}, {-40, 0}};

TEST(Breach, GoesFromWhereTheSideComesOutToWhereItGoesInAgain) {
  const auto found = breaches_in(kUndercut);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].from_mm, 1.0 / 2.75 * 3, kEnds_mm);
  EXPECT_NEAR(found[0].to_mm, 3 + 1.75 / 22.25 * 27, kEnds_mm);
  EXPECT_TRUE(breaches_in(kUndercut, 5).empty());
}

TEST(Breach, GoesFromMouthToExitAlongAFace) {
  const auto found = breaches_in({{3, 0}, {3, 30}, {-40, 30}, {-40, 0}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].from_mm, 0, kEnds_mm);
  EXPECT_NEAR(found[0].to_mm, 30, kEnds_mm);
}

// Two notches in its way, 4.5 mm from the axis at 6 and 10, and at 18 and 22; the ridge between them is bone.
TEST(Breach, IsToldFromTheNextOne) {
  const auto found = breaches_in({{8.5, 0},
                                  {6.5, 4},
                                  {2.5, 8},
                                  {6.5, 12},
                                  {6.5, 16},
                                  {2.5, 20},
                                  {6.5, 24},
                                  {6.5, 30},
                                  {-40, 30},
                                  {-40, 0}});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].from_mm, 6, kEnds_mm);
  EXPECT_NEAR(found[0].to_mm, 10, kEnds_mm);
  EXPECT_NEAR(found[1].from_mm, 18, kEnds_mm);
  EXPECT_NEAR(found[1].to_mm, 22, kEnds_mm);
}

}  // namespace
}  // namespace arthronaut::tunnels
