#include "app/plan/tunnel_moves.h"

#include <gtest/gtest.h>

#include "app/plan/anatomical_text.h"
#include "planning/geometry/rigid_transform.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::plan {
namespace {

// A slab of bone in front of an anterior camera: its front face lies at y = 0, the bone behind it.
geometry::Surface slab() { return geometry::Surface(test::box({50, 15, 50}, {0, 15, 0})); }

// The camera looks posteriorly: +x is to the right of the picture, +z up.
scene::SceneCamera anterior() { return scene::look_along({0, 1, 0}, {0, 0, 0}, 200, {0, 0, 1}); }

tunnels::Tunnel straight() {
  tunnels::Tunnel tunnel;
  tunnel.entry_mm = {1, 0, 2};
  tunnel.direction = Eigen::Vector3d(0.1, 1, 0).normalized();
  return tunnel;
}

// One graft made two: each as wide as is usual, unless somebody chose its width.
TEST(TunnelMoves, AnotherGraftIsAsWideAsIsUsualOfIt) {
  tunnels::Tunnel single = straight();
  single.diameter_mm = 9;
  EXPECT_EQ(for_graft(single, norms::Bundle::Anteromedial).diameter_mm, 7);
  EXPECT_EQ(for_graft(single, norms::Bundle::Posterolateral).diameter_mm, 6);
  EXPECT_EQ(for_graft(for_graft(single, norms::Bundle::Anteromedial), norms::Bundle::Whole).diameter_mm, 9);
  single.diameter_mm = 8.5;
  EXPECT_EQ(for_graft(single, norms::Bundle::Anteromedial).diameter_mm, 8.5);
}

// A click puts the entry there and keeps the aim.
TEST(TunnelMoves, EntryFollowsTheClick) {
  const tunnels::Tunnel moved = with_entry_at(straight(), {7, 0, 9});
  EXPECT_EQ(moved.entry_mm, Eigen::Vector3d(7, 0, 9));
  EXPECT_EQ(moved.direction, straight().direction);
}

// One press of an arrow key turns by exactly its angle, and the far end moves that way on the screen.
TEST(TunnelMoves, AimTurnsTheFarEndThatWay) {
  const tunnels::Tunnel right = turned(straight(), anterior(), {1, 0});
  EXPECT_NEAR(geometry::deg_from_rad(geometry::angle_between_rad(right.direction, straight().direction)), 1,
              1e-9);
  EXPECT_GT(right.direction.x(), straight().direction.x());
  const tunnels::Tunnel up = turned(straight(), anterior(), {0, 1});
  EXPECT_GT(up.direction.z(), straight().direction.z());
  EXPECT_NEAR(up.direction.norm(), 1, 1e-12);
  EXPECT_EQ(up.entry_mm, straight().entry_mm);
}

// A tunnel that already points to the right of the screen can't be turned further to the right.
TEST(TunnelMoves, AimStopsWhereItPointsThatWay) {
  tunnels::Tunnel sideways = straight();
  sideways.direction = Eigen::Vector3d::UnitX();
  EXPECT_EQ(turned(sideways, anterior(), {1, 0}).direction, sideways.direction);
}

// Sliding moves the entry along the surface.
TEST(TunnelMoves, SlidingStaysOnTheBone) {
  const tunnels::Tunnel slid = with_entry_slid(straight(), anterior(), {0.5, -0.25}, slab());
  EXPECT_NEAR((slid.entry_mm - Eigen::Vector3d(1.5, 0, 1.75)).norm(), 0, 1e-9);
}

// The handle is under the mouse, and the tunnel runs towards it.
TEST(TunnelMoves, AimsAtThePoint) {
  const Eigen::Vector3d wanted = straight().entry_mm + Eigen::Vector3d(6, 40, -4);
  EXPECT_NEAR((aimed_at(straight(), wanted).direction - (wanted - straight().entry_mm).normalized()).norm(),
              0, 1e-9);
  EXPECT_EQ(aimed_at(straight(), straight().entry_mm).direction, straight().direction);
}

// An aim that a hand brings back is the one that it was, however far it was away.
TEST(TunnelMoves, AnAimDraggedOutAndBackIsAsItWas) {
  const scene::SceneCamera camera = anterior();
  Eigen::Vector3d handle = straight().entry_mm + 45 * straight().direction;
  const Eigen::Vector3d before = handle;
  tunnels::Tunnel tunnel = straight();
  for (const double out_mm : {5, 20, 60, 90, 60, 20, 5, 0}) {
    const Eigen::Vector3d mouse = before + out_mm * Eigen::Vector3d::UnitX();
    handle = *moved_in_view(camera, {camera.position_mm, (mouse - camera.position_mm).normalized()}, handle);
    tunnel = aimed_at(tunnel, handle);
  }
  EXPECT_NEAR((tunnel.direction - straight().direction).norm(), 0, 1e-9);
}

// What is dragged in the view's plane stays as deep as it was, under the mouse.
TEST(TunnelMoves, WhatIsMovedInTheViewStaysAsDeep) {
  const scene::SceneCamera camera = anterior();
  const Eigen::Vector3d point(3, 17, -5),
      wanted = point + Eigen::Vector3d(-8, 0, 11);  // the eye looks along y
  const scene::SceneRay ray{camera.position_mm, (wanted - camera.position_mm).normalized()};
  const auto moved = moved_in_view(camera, ray, point);
  ASSERT_TRUE(moved);
  EXPECT_NEAR((*moved - wanted).norm(), 0, 1e-9);
  EXPECT_FALSE(moved_in_view(camera, {camera.position_mm, -ray.direction}, point));
}

// A diameter stays within what a drill can be.
TEST(TunnelMoves, DiameterIsClamped) {
  EXPECT_EQ(with_diameter(straight(), 9.5).diameter_mm, 9.5);
  EXPECT_EQ(with_diameter(straight(), 99).diameter_mm, 15);
  EXPECT_EQ(with_diameter(straight(), 0).diameter_mm, 3);
}

// A displacement in words: lateral changes sign with the side, small parts are not named, the axes are the
// bone's.
TEST(AnatomicalText, FollowsSideAndAxes) {
  EXPECT_EQ(anatomical_text({-28, -12, 14}, landmarks::scanner_axes(bones::Side::Right)),
            "14 mm proximal, 28 mm lateral, 12 mm anterior");
  EXPECT_EQ(anatomical_text({-28, 0.2, 0}, landmarks::scanner_axes(bones::Side::Left)), "28 mm medial");
  EXPECT_EQ(place_from_entry({-28, 0.2, 0}, landmarks::scanner_axes(bones::Side::Left)),
            "28 mm medial of the entry");
  EXPECT_EQ(place_from_entry({0, 0, 0.3}, landmarks::scanner_axes(bones::Side::Left)), "at the entry");
  landmarks::AnatomicalAxes turned;  // a bone that lies on its back, the shaft along +x
  turned.proximal = Eigen::Vector3d::UnitX();
  turned.anterior = Eigen::Vector3d::UnitZ();
  turned.lateral = Eigen::Vector3d::UnitY();
  EXPECT_EQ(anatomical_text({10, 0, -3}, turned), "10 mm proximal, 3 mm posterior");
}

}  // namespace
}  // namespace arthronaut::plan
