#include "navigation/simulator/solids.h"

#include <gtest/gtest.h>

namespace arthronaut::simulator {
namespace {

using Eigen::Vector3d;

// A plate 20 mm in front of the lens that faces it, as the camera frame has it.
geometry::RigidTransform facing_at(double depth_mm) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(geometry::kPi, Vector3d::UnitX())), {0, 0, depth_mm}};
}

// The border of every marker of the dictionary is black, and no two markers are alike.
TEST(MarkerCells, HaveABlackBorderAndDiffer) {
  for (int id = 0; id < 50; ++id) {
    const MarkerCells cells = marker_cells(id);
    ASSERT_EQ(cells.count, 6);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_FALSE(cells.is_white[i] || cells.is_white[30 + i] || cells.is_white[6 * i] ||
                   cells.is_white[6 * i + 5])
          << id;
    }
    for (int other = 0; other < id; ++other) EXPECT_NE(cells, marker_cells(other));
  }
}

// The ink of a plate lies where the marker's frame says: x to the right, y up.
TEST(Plate, ShowsTheCellsOfItsMarker) {
  PlateShape shape;
  shape.markers = {{Eigen::Vector2d::Zero(), 4.0, marker_cells(7)}};
  const auto plate = make_plate(facing_at(20), shape);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      // Seen by the lens the marker is upright: its y is the picture's -y.
      const Vector3d direction(((column + 0.5) / 6 - 0.5) * 4 / 20, ((row + 0.5) / 6 - 0.5) * 4 / 20, 1);
      SolidHit hit, beside;
      ASSERT_TRUE(plate->hit(direction, hit));
      EXPECT_NEAR(hit.depth_mm, 20, 1e-12);
      ASSERT_TRUE(plate->hit(Vector3d(2.5 / 20, 0, 1), beside));  // the white around it
      const bool is_white = shape.markers[0].cells.is_white[static_cast<std::size_t>(6 * row + column)];
      EXPECT_EQ(hit.region == beside.region, is_white) << row << " " << column;
    }
  }
}

// Rays past the plate miss it; a plate that is turned away shows no print.
TEST(Plate, IsMissedBesideItsEdge) {
  const auto plate = make_plate(facing_at(20), {});
  SolidHit hit;
  EXPECT_TRUE(plate->hit(Vector3d(2.99 / 20, 0, 1), hit));
  EXPECT_FALSE(plate->hit(Vector3d(3.01 / 20, 0, 1), hit));
}

// A rod is met at its surface, with the normal of a cylinder and of a ball at its ends.
TEST(Rod, IsMetAtItsSurface) {
  const auto rod = make_rod({-5, 0, 30}, {5, 0, 30}, 2, steel());
  SolidHit hit;
  ASSERT_TRUE(rod->hit(Vector3d(0, 0, 1), hit));
  EXPECT_NEAR(hit.depth_mm, 28, 1e-12);
  EXPECT_NEAR((hit.normal - Vector3d(0, 0, -1)).norm(), 0, 1e-12);
  ASSERT_TRUE(rod->hit(Vector3d(6.0 / 30, 0, 1), hit));
  const Vector3d at = hit.depth_mm * Vector3d(6.0 / 30, 0, 1);
  EXPECT_NEAR((at - Vector3d(5, 0, 30)).norm(), 2, 1e-9);
  EXPECT_FALSE(rod->hit(Vector3d(8.0 / 30, 0, 1), hit));
}

// Squares of a checkerboard alternate, also across its origin.
TEST(Checkerboard, Alternates) {
  const auto board = make_checkerboard(facing_at(15), 1.5);
  int previous = -1;
  for (int i = -4; i <= 4; ++i) {
    SolidHit hit;
    ASSERT_TRUE(board->hit(Vector3d((i + 0.5) * 1.5 / 15, 0.01, 1), hit));
    EXPECT_NE(hit.region, previous);
    previous = hit.region;
  }
}

}  // namespace
}  // namespace arthronaut::simulator
