#include "planning/tunnels/tunnel.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::tunnels {
namespace {

using Eigen::Vector3d;

// A slab 40 mm thick: length, exit and wall have closed forms.
class TunnelInABox : public ::testing::Test {
 protected:
  geometry::Surface bone_{test::box({50, 30, 20})};
};

TEST_F(TunnelInABox, MeasuresAStraightTunnelExactly) {
  const auto measured = measure({.entry_mm = {10, 4, -20}, .direction = {0, 0, 1}, .diameter_mm = 9}, bone_);
  ASSERT_TRUE(measured.enters_bone);
  EXPECT_NEAR(measured.length_mm, 40, 1e-9);
  EXPECT_LT((measured.exit_mm - Vector3d(10, 4, 20)).norm(), 1e-9);
  // Straight away from the axis the nearest face is the side y = 30.
  EXPECT_NEAR(measured.wall_mm, 26 - 4.5, 1e-4);
  EXPECT_NEAR(measured.thinnest_mm.y(), 30, 1e-4);
  EXPECT_NEAR(measured.entry.angle_to_surface_deg, 90, 1e-9);
  EXPECT_NEAR(measured.entry.area_mm2, geometry::kPi * 4.5 * 4.5, 1e-9);
}

TEST_F(TunnelInABox, MeasuresASlantedTunnelExactly) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> slant(-0.5, 0.5);
  for (int i = 0; i < 200; ++i) {
    const double dx = slant(random), dy = slant(random);
    const Vector3d direction = Vector3d(dx, dy, 1).normalized(), entry(0, 0, -20);
    const auto measured = measure({.entry_mm = entry, .direction = direction}, bone_);
    ASSERT_TRUE(measured.enters_bone);
    EXPECT_NEAR(measured.length_mm, 40 / direction.z(), 1e-9);
    EXPECT_LT((measured.exit_mm - (entry + measured.length_mm * direction)).norm(), 1e-9);
  }
}

// 9 mm at 40 deg to the surface opens in an ellipse of 14.0 mm and 99 mm^2, as Hensler 2011 measured.
TEST_F(TunnelInABox, MeasuresASlantingMouth) {
  const double angle = geometry::rad_from_deg(40);
  const auto measured = measure(
      {.entry_mm = {-20, 0, -20}, .direction = {std::cos(angle), 0, std::sin(angle)}, .diameter_mm = 9},
      bone_);
  ASSERT_TRUE(measured.enters_bone);
  EXPECT_NEAR(measured.entry.angle_to_surface_deg, 40, 1e-9);
  EXPECT_NEAR(measured.entry.long_mm, 9 / std::sin(angle), 1e-9);
  EXPECT_NEAR(measured.entry.long_mm, 14.0, 0.05);
  EXPECT_NEAR(measured.entry.area_mm2, 99, 0.5);
  EXPECT_LT((measured.entry.long_axis - Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_LT((measured.entry.normal + Vector3d::UnitZ()).norm(), 1e-9);
  EXPECT_LT((measured.exit.normal - Vector3d::UnitZ()).norm(), 1e-9);
}

// The side wall of a tunnel near an edge of the slab: 26 mm off the middle leaves 4 mm to the face.
TEST_F(TunnelInABox, FindsTheThinWall) {
  const auto measured = measure({.entry_mm = {0, 26, -20}, .direction = {0, 0, 1}, .diameter_mm = 6}, bone_);
  EXPECT_NEAR(measured.wall_mm, 4 - 3, 1e-4);
  const auto broken = measure({.entry_mm = {0, 28, -20}, .direction = {0, 0, 1}, .diameter_mm = 6}, bone_);
  EXPECT_NEAR(broken.wall_mm, 2 - 3, 1e-4);
}

// A planned entry may float off the bone a little, in or out: the axis decides.
TEST_F(TunnelInABox, TakesTheEntryWithinFiveMillimetres) {
  for (const double off : {-4.9, -1.0, 2.0, 4.9}) {
    const auto measured = measure({.entry_mm = {0, 0, -20 + off}, .direction = {0, 0, 1}}, bone_);
    ASSERT_TRUE(measured.enters_bone) << off;
    EXPECT_LT((measured.entry_on_surface_mm - Vector3d(0, 0, -20)).norm(), 1e-9);
    EXPECT_NEAR(measured.length_mm, 40, 1e-9);
  }
  EXPECT_FALSE(measure({.entry_mm = {0, 0, -25.2}, .direction = {0, 0, 1}}, bone_).enters_bone);
}

TEST_F(TunnelInABox, SaysWhenItDoesNotEnter) {
  EXPECT_FALSE(
      measure({.entry_mm = {0, 0, -20}, .direction = {0, 0, -1}}, bone_).enters_bone);  // out of the bone
  EXPECT_FALSE(measure({.entry_mm = {60, 0, -20}, .direction = {0, 0, 1}}, bone_).enters_bone);  // beside it
}

// A condyle after a gap is not part of the tunnel: it ends where the axis first leaves the bone.
TEST(Tunnel, EndsAtTheFirstExit) {
  auto two = test::box({10, 10, 10});
  const auto further = test::box({10, 10, 10});
  const auto offset = static_cast<std::int32_t>(two.vertices_mm.size());
  for (const auto& v : further.vertices_mm) two.vertices_mm.push_back(v + Vector3d(0, 0, 40));
  for (const auto& t : further.triangles)
    two.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  const auto measured = measure({.entry_mm = {1, 2, -10}, .direction = {0, 0, 1}}, geometry::Surface(two));
  ASSERT_TRUE(measured.enters_bone);
  EXPECT_NEAR(measured.length_mm, 20, 1e-9);
}

}  // namespace
}  // namespace arthronaut::tunnels
