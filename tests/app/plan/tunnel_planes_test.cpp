#include "app/plan/tunnel_planes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace arthronaut::plan {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-12;  // of unit vectors in double precision

TunnelAxis random_axis(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return Vector3d(normal(random), normal(random), normal(random)).normalized();
  };
  const Vector3d along = direction(), up = direction();
  return {.name = "femur", .entry_mm = 40 * direction(), .direction = along, .up = up};
}

// Whatever the tunnel and however it is turned: two planes hold the axis and are square to each other, the
// third is square to it, and none is a mirror image.
TEST(TunnelPlanes, HoldTheAxisHoweverTheyAreTurned) {
  std::mt19937 random(11);
  for (int i = 0; i < 200; ++i) {
    const TunnelAxis axis = random_axis(random);
    for (const double turned_rad : {0.0, 0.3, 1.5, 3.0, -2.0}) {
      const TunnelPlanes planes = tunnel_planes(axis, turned_rad);
      EXPECT_NEAR(planes.along.normal().dot(axis.direction), 0, kRounding);
      EXPECT_NEAR(planes.square.normal().dot(axis.direction), 0, kRounding);
      EXPECT_NEAR(planes.along.normal().dot(planes.square.normal()), 0, kRounding);
      EXPECT_NEAR(planes.across.normal().dot(axis.direction), 1, kRounding);
      for (const PictureAxes& picture : {planes.across, planes.along, planes.square}) {
        EXPECT_NEAR(picture.right.dot(picture.down), 0, kRounding);
        EXPECT_NEAR(picture.normal().norm(), 1, kRounding);
        EXPECT_LE(picture.down.dot(axis.up), 0.1) << "up in the bone points down on the screen";
      }
    }
  }
}

// A turn by an angle turns the plane by that angle about the axis, and half a turn shows the same plane.
TEST(TunnelPlanes, TurnByTheAngle) {
  std::mt19937 random(12);
  for (int i = 0; i < 100; ++i) {
    const TunnelAxis axis = random_axis(random);
    const Vector3d before = tunnel_planes(axis, 0.2).along.normal();
    const Vector3d after = tunnel_planes(axis, 0.2 + 0.35).along.normal();
    EXPECT_NEAR(before.cross(after).norm(), std::sin(0.35), 1e-9);
    const Vector3d half = tunnel_planes(axis, 0.2 + EIGEN_PI).along.normal();
    EXPECT_NEAR(before.cross(half).norm(), 0, 1e-9);
  }
}

// A tunnel straight up the bone has no upright plane of its own: one is taken all the same.
TEST(TunnelPlanes, OfATunnelThatRunsStraightUpAreThere) {
  const TunnelPlanes planes =
      tunnel_planes({.name = "tibia", .direction = Vector3d::UnitZ(), .up = Vector3d::UnitZ()}, 0);
  EXPECT_NEAR(planes.along.normal().norm(), 1, kRounding);
  EXPECT_NEAR(planes.along.normal().z(), 0, kRounding);
  EXPECT_NEAR(planes.across.normal().z(), 1, kRounding);
}

// Where the wall is thinnest lies anywhere about the tunnel: the planes turn until the first holds it.
TEST(TunnelPlanes, TurnToHoldAPoint) {
  std::mt19937 random(13);
  std::normal_distribution<double> normal(0, 10);
  for (int i = 0; i < 200; ++i) {
    const TunnelAxis axis = random_axis(random);
    const Vector3d point = axis.entry_mm + Vector3d(normal(random), normal(random), normal(random));
    const double turned_rad = turned_to_hold_rad(axis, point);
    EXPECT_LE(std::abs(turned_rad), EIGEN_PI / 2 + kRounding);
    const Vector3d across = tunnel_planes(axis, turned_rad).along.normal();
    EXPECT_NEAR(across.dot(point - axis.entry_mm), 0, 1e-9);
  }
  const TunnelAxis axis = random_axis(random);
  EXPECT_EQ(turned_to_hold_rad(axis, axis.entry_mm), 0);
}

TEST(TunnelPlanes, ThePointOnTheAxisIsTheNearest) {
  const TunnelAxis axis{.name = "", .entry_mm = {1, 2, 3}, .direction = Vector3d::UnitX()};
  EXPECT_TRUE(on_axis(axis, {9, 5, -4}).isApprox(Vector3d(9, 2, 3)));
}

}  // namespace
}  // namespace arthronaut::plan
