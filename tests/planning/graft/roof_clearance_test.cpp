#include "planning/graft/roof_clearance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::graft {
namespace {

using Eigen::Vector3d;

// In the lateral view of a right knee (anterior -y, proximal z): a tunnel at 60 deg to the plateau, going up
// and back, and a roof that runs parallel, `ahead_mm` in front of its axis.
RoofQuery parallel(double ahead_mm, double roof_deg = 60) {
  const double angle = geometry::rad_from_deg(60), roof = geometry::rad_from_deg(roof_deg);
  const Vector3d up_tunnel(0, std::cos(angle), std::sin(angle)), up_roof(0, std::cos(roof), std::sin(roof)),
      forwards(0, -std::sin(angle), std::cos(angle));
  const Vector3d opening(3, 1, -2),
      outlet = opening + 15 * up_tunnel + ahead_mm * forwards + Vector3d(-7, 0, 0);
  return {.tibial_opening_mm = opening,
          .into_tibia = -up_tunnel,
          .diameter_mm = 9,
          .blumensaat_anterior_mm = outlet,
          .blumensaat_posterior_mm = outlet + 25 * up_roof,
          .femur_axes = landmarks::scanner_axes(bones::Side::Right)};
}

TEST(RoofClearance, IsTheDistanceToAParallelRoof) {
  for (const double ahead : {2.0, 4.5, 8.0}) {
    const auto clearance = roof_clearance(parallel(ahead));
    ASSERT_TRUE(clearance);
    EXPECT_NEAR(clearance->outlet_mm, ahead - 4.5, 1e-9);
    EXPECT_NEAR(clearance->opening_mm, ahead - 4.5, 1e-9);
  }
}

// A flatter roof, prolonged to the plateau, comes down further in front: its slope clears the opening by more
// than the outlet does.
TEST(RoofClearance, OfAFlatterRoofIsGreaterAtTheOpening) {
  const auto clearance = roof_clearance(parallel(6, 50));
  ASSERT_TRUE(clearance);
  EXPECT_NEAR(clearance->outlet_mm, 1.5, 1e-9);
  EXPECT_GT(clearance->opening_mm, 1.5);
}

TEST(RoofClearance, NeedsALine) {
  RoofQuery query = parallel(6);
  query.blumensaat_posterior_mm = query.blumensaat_anterior_mm + Vector3d(20, 0, 1);  // seen end on
  EXPECT_FALSE(roof_clearance(query));
}

}  // namespace
}  // namespace arthronaut::graft
