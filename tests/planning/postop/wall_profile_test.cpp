// Profiles made of three levels and a blur that are known.
#include "planning/postop/wall_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace arthronaut::postop {
namespace {

struct Wall3 {
  double wall_mm = 0, rim_mm = 0, rim_hu = 0, blur_mm = 0.4;
  double slope_hu_per_mm = 0;  // beyond the wall
  double inside_hu = 60, beyond_hu = 160;
};

// As of a tunnel: some 1000 voxels to a point, their noise 25 HU.
std::vector<WallPoint> points_of(const Wall3& truth) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 25 / std::sqrt(1000.0 / 4));
  std::vector<WallPoint> points;
  for (double off_mm = -2.9; off_mm < 3; off_mm += 0.2) {
    const WallGrey grey = wall_grey(off_mm - truth.wall_mm, truth.rim_mm, truth.blur_mm);
    points.push_back({off_mm,
                      truth.inside_hu * grey.inside + truth.rim_hu * grey.rim +
                          truth.beyond_hu * grey.beyond +
                          truth.slope_hu_per_mm * std::max(0.0, off_mm - truth.wall_mm) + noise(random),
                      1000});
  }
  return points;
}

}  // namespace

TEST(WallProfile, ARimIsTakenWhereThereIsOne) {
  const WallProfile plain = explain_wall(points_of({.wall_mm = 0.1}), 25, 4);
  EXPECT_FALSE(plain.has_rim());
  EXPECT_NEAR(plain.wall_mm, 0.1, 0.05);
  for (const double rim_mm : {0.7, 1.0, 1.4}) {
    const WallProfile rimmed =
        explain_wall(points_of({.wall_mm = 0.3, .rim_mm = rim_mm, .rim_hu = 400}), 25, 4);
    ASSERT_TRUE(rimmed.has_rim());
    // Half of 0.3 mm of diameter, each.
    EXPECT_NEAR(rimmed.wall_mm, 0.3, 0.15) << rim_mm;
    EXPECT_NEAR(rimmed.rim_mm, rim_mm, 0.3) << rim_mm;
    EXPECT_NEAR(rimmed.blur_mm, 0.4, 0.1) << rim_mm;
  }
}

// Marrow with grain is denser beside the wall by chance, too: such a ring of 30 to 36 HU was told as a rim,
// of a tunnel 0.23 mm too wide. That it may be one is said. Tolerance: three sigma.
TEST(WallProfile, GrainIsNotTakenForARim) {
  const WallProfile grainy = explain_wall(points_of({.rim_mm = 0.6, .rim_hu = 200}), 34, 4);
  EXPECT_FALSE(grainy.has_rim());
  EXPECT_GT(grainy.wall_sigma_mm, std::abs(grainy.wall_mm) / 3);
  EXPECT_TRUE(explain_wall(points_of({.rim_mm = 0.6, .rim_hu = 300}), 34, 4).has_rim());
}

// From a wall that was taken where the rim ends, which is an edge as sharp: such a tunnel came out 2 mm too
// wide, reliably. Tolerance: half of 0.3 mm of diameter.
TEST(WallProfile, ARimIsTakenFromItsOuterSideToo) {
  for (const double rim_mm : {0.8, 1.2, 1.6}) {
    for (const double inside_hu : {60.0, 150.0}) {
      const WallProfile rimmed = explain_wall(
          points_of(
              {.wall_mm = -rim_mm, .rim_mm = rim_mm, .rim_hu = 435, .blur_mm = 0.5, .inside_hu = inside_hu}),
          25, 4);
      EXPECT_NEAR(rimmed.wall_mm, -rim_mm, 0.15) << inside_hu;
      EXPECT_NEAR(rimmed.rim_mm, rim_mm, 0.3) << inside_hu;
    }
  }
}

// Bone that is half as dense for a millimetre beside the bore: its outer side was taken for the wall, and a
// tunnel came out 2 mm too wide, reliably. Seen from its inner side it may be marrow before cortex; and
// neither even marrow, nor one that changes, nor a rim has a layer.
TEST(WallProfile, ALayerBetweenBoreAndBoneIsTold) {
  const auto seen_from = [](double wall_mm) {
    const Wall3 truth{.wall_mm = wall_mm, .rim_mm = 1.2, .rim_hu = 435, .blur_mm = 0.35, .beyond_hu = 1379};
    return explain_wall(points_of(truth), 25, 4);
  };
  EXPECT_NEAR(seen_from(-1.0).layer_mm, 1.2, 0.3);
  EXPECT_EQ(seen_from(0).layer_mm, 0);
  for (const double blur_mm : {0.3, 0.6, 0.9}) {
    for (const Wall3& one :
         {Wall3{.blur_mm = blur_mm}, Wall3{.wall_mm = 0.2, .blur_mm = blur_mm, .slope_hu_per_mm = 30},
          Wall3{.rim_mm = 1, .rim_hu = 400, .blur_mm = blur_mm},
          Wall3{.blur_mm = blur_mm, .beyond_hu = 1379}})
      EXPECT_EQ(explain_wall(points_of(one), 25, 4).layer_mm, 0) << blur_mm << ' ' << one.slope_hu_per_mm;
  }
}

// Through more blur the wall is less surely known; and it is no further off than said.
TEST(WallProfile, AThinRimIsKnownTheLessTheMoreItIsBlurred) {
  const auto seen_through = [](double blur_mm) {
    return explain_wall(points_of({.wall_mm = 0.2, .rim_mm = 0.5, .rim_hu = 400, .blur_mm = blur_mm}), 25, 4);
  };
  const WallProfile sharp = seen_through(0.2), blurred = seen_through(0.5);
  EXPECT_GT(blurred.wall_sigma_mm, 2 * sharp.wall_sigma_mm);
  for (const WallProfile& seen : {sharp, blurred})
    EXPECT_LT(std::abs(seen.wall_mm - 0.2), 3 * seen.wall_sigma_mm + 0.02) << seen.blur_mm;
}

// Marrow that is denser towards the cortex was taken for blur, and such tunnels were refused.
TEST(WallProfile, MarrowThatChangesBesideTheWallIsNoBlur) {
  for (const double blur_mm : {0.4, 0.8})
    for (const double slope : {0.0, 15.0, 30.0})
      EXPECT_NEAR(
          explain_wall(points_of({.blur_mm = blur_mm, .slope_hu_per_mm = slope}), 25, 4).plain_blur_mm,
          blur_mm, 0.1)
          << blur_mm << " mm, " << slope << " HU/mm";
}

// Beside cortex no rim is denser: how well the wall is known was no number then, which passed for known.
TEST(WallProfile, WhereNoRimCanBeTheWallIsKnownAllTheSame) {
  const WallProfile seen = explain_wall(points_of({.wall_mm = 0.1, .beyond_hu = 1379}), 25, 4);
  EXPECT_FALSE(seen.has_rim());
  EXPECT_NEAR(seen.wall_mm, 0.1, 0.05);
  EXPECT_LT(seen.wall_sigma_mm, 0.05);
}

TEST(WallProfile, TooFewPointsTellNothing) {
  auto points = points_of({});
  points.resize(5);
  const WallProfile seen = explain_wall(points, 25, 4);
  EXPECT_FALSE(seen.has_rim());
  EXPECT_TRUE(std::isinf(seen.wall_sigma_mm));
}

}  // namespace arthronaut::postop
