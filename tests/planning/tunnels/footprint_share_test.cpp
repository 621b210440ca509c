#include "planning/tunnels/footprint_share.h"

#include <gtest/gtest.h>

#include <cmath>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tunnels {
namespace {

using Eigen::Vector3d;

TunnelMouth mouth(double long_mm, double short_mm) {
  return {.at_mm = {5, 0, 0},
          .normal = {1, 0, 0},
          .long_axis = {0, 0, 1},
          .long_mm = long_mm,
          .short_mm = short_mm,
          .area_mm2 = geometry::kPi / 4 * long_mm * short_mm};
}

std::vector<Vector3d> rectangle(double y_from, double y_to, double z_from, double z_to) {
  return {{5, y_from, z_from}, {5, y_to, z_from}, {5, y_to, z_to}, {5, y_from, z_to}};
}

// Whole, half and none of an ellipse; the outline may run either way round.
TEST(FootprintShare, MeasuresWhatBothHave) {
  const auto opening = mouth(14, 9);
  const double area = opening.area_mm2;
  auto share = footprint_share(opening, rectangle(-20, 20, -20, 20));
  EXPECT_NEAR(share.footprint_mm2, 1600, 1e-9);
  EXPECT_NEAR(share.shared_mm2, area, 0.02);
  EXPECT_NEAR(share.of_opening(), 1, 2e-4);
  share = footprint_share(opening, rectangle(20, 0, -20, 20));
  EXPECT_NEAR(share.shared_mm2, area / 2, 0.02);
  EXPECT_NEAR(share.of_footprint(), area / 2 / 800, 1e-4);
  EXPECT_EQ(footprint_share(opening, rectangle(8, 20, -20, 20)).shared_mm2, 0);
  EXPECT_EQ(footprint_share(opening, {}).of_footprint(), 0);
}

// A footprint within the opening is opened wholly.
TEST(FootprintShare, OpensASmallFootprintWholly) {
  const auto share = footprint_share(mouth(14, 9), rectangle(-2, 2, -3, 3));
  EXPECT_NEAR(share.of_footprint(), 1, 1e-9);
  EXPECT_NEAR(share.footprint_mm2, 24, 1e-9);
}

}  // namespace
}  // namespace arthronaut::tunnels
