#include "planning/tunnels/footprint_share.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "planning/geometry/rigid_transform.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::tunnels {
namespace {

using Eigen::Vector3d;
using geometry::kPi;

// On the face x = 5 of a box.
geometry::SurfacePatch rectangle(double y_from, double y_to, double z_from, double z_to) {
  static const geometry::Surface box(test::box({5, 60, 60}));
  return geometry::patch_within(box,
                                {{5, y_from, z_from}, {5, y_to, z_from}, {5, y_to, z_to}, {5, y_from, z_to}});
}

// Into that face at its middle, `tilt_deg` off its normal.
Tunnel tunnel(double diameter_mm, double tilt_deg = 0) {
  const double tilt = geometry::rad_from_deg(tilt_deg);
  return {.bone = bones::BoneKind::Femur,
          .entry_mm = {5, 0, 0},
          .direction = {-std::cos(tilt), 0, std::sin(tilt)},
          .diameter_mm = diameter_mm};
}

// Whole, half and none of a circle.
TEST(FootprintShare, MeasuresWhatBothHave) {
  const double area_mm2 = kPi / 4 * 9 * 9;
  FootprintShare share = footprint_share(tunnel(9), rectangle(-20, 20, -20, 20));
  EXPECT_NEAR(share.footprint_mm2, 1600, 1e-9);
  EXPECT_NEAR(share.shared_mm2, area_mm2, 0.02);
  EXPECT_NEAR(share.of_opening, 1, 1e-9);
  share = footprint_share(tunnel(9), rectangle(20, 0, -20, 20));
  EXPECT_NEAR(share.shared_mm2, area_mm2 / 2, 0.02);
  EXPECT_NEAR(share.of_footprint(), area_mm2 / 2 / 800, 1e-4);
  EXPECT_NEAR(share.of_opening, 0.5, 1e-3);
  EXPECT_EQ(footprint_share(tunnel(9), rectangle(8, 20, -20, 20)).shared_mm2, 0);
  EXPECT_EQ(footprint_share(tunnel(9), {}).of_footprint(), 0);
}

// A footprint within the opening is opened wholly.
TEST(FootprintShare, OpensASmallFootprintWholly) {
  const auto share = footprint_share(tunnel(14), rectangle(-2, 2, -3, 3));
  EXPECT_NEAR(share.of_footprint(), 1, 1e-9);
  EXPECT_NEAR(share.footprint_mm2, 24, 1e-9);
}

// A slanting drill opens an ellipse: more of the bone, and the footprint is as large as before.
TEST(FootprintShare, OfASlantingDrillIsTheEllipseOnTheBone) {
  for (const double tilt_deg : {0.0, 20.0, 40.0, 60.0}) {
    const auto share = footprint_share(tunnel(9, tilt_deg), rectangle(-30, 30, -30, 30));
    EXPECT_NEAR(share.footprint_mm2, 3600, 1e-9);
    EXPECT_NEAR(share.shared_mm2, kPi / 4 * 81 / std::cos(geometry::rad_from_deg(tilt_deg)), 0.05);
    EXPECT_NEAR(share.of_opening, 1, 1e-9);
  }
}

// On a ball the footprint is the cap, whatever the aim; a drill along its axis opens the cap of its radius.
TEST(FootprintShare, OnABallTheFootprintIsTheCapWhateverTheAim) {
  constexpr double kRadius_mm = 15;
  const geometry::Surface ball(test::ellipsoid(Vector3d::Constant(kRadius_mm), 5));
  std::vector<Vector3d> outline;
  for (int i = 0; i < 90; ++i)
    outline.push_back(
        ball.closest_point({8 * std::cos(2 * kPi * i / 90), 8 * std::sin(2 * kPi * i / 90), 12.69}).point_mm);
  const auto cap_mm2 = [](double radius_mm) {
    return 2 * kPi * kRadius_mm * (kRadius_mm - std::sqrt(kRadius_mm * kRadius_mm - radius_mm * radius_mm));
  };
  const auto patch = geometry::patch_within(ball, outline);
  EXPECT_NEAR(patch.area_mm2, cap_mm2(8), 0.005 * cap_mm2(8));
  double least_mm2 = 1e9, greatest_mm2 = 0;
  for (const double tilt_deg : {0.0, 25.0, 50.0}) {
    const double tilt = geometry::rad_from_deg(tilt_deg);
    const Tunnel aimed{.bone = bones::BoneKind::Femur,
                       .entry_mm = {0, 0, kRadius_mm},
                       .direction = {std::sin(tilt), 0, -std::cos(tilt)},
                       .diameter_mm = 9};
    const auto share = footprint_share(aimed, patch);
    least_mm2 = std::min(least_mm2, share.footprint_mm2);
    greatest_mm2 = std::max(greatest_mm2, share.footprint_mm2);
    if (tilt_deg == 0) {
      EXPECT_NEAR(share.shared_mm2, cap_mm2(4.5), 0.005 * cap_mm2(4.5));
    }
    EXPECT_GT(share.shared_mm2, 0.98 * cap_mm2(4.5)) << tilt_deg;
    EXPECT_LE(share.shared_mm2, patch.area_mm2);
  }
  EXPECT_EQ(least_mm2, greatest_mm2);
}

}  // namespace
}  // namespace arthronaut::tunnels
