#include "navigation/simulator/solids.h"

#include <gtest/gtest.h>

#include <random>

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

// Many rays at once meet what each meets alone, but for those within 0.002 px of an edge.
TEST(Solids, AreMetAlikeByRaysTogetherAndAlone) {
  std::vector<std::unique_ptr<Solid>> solids;
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.5, Vector3d(0.6, 0.8, 0)));
  const geometry::RigidTransform tilted{tilt * facing_at(20).rotation, {0.4, -0.3, 21}};
  PlateShape square, disc, ruler;
  square.markers = {{{0, 0}, 4.0, marker_cells(7)}};
  disc.is_round = true;
  disc.thickness_mm = 3;
  disc.markers = {{{0.2, 0.1}, 3.5, marker_cells(12)}};
  ruler.half_size_mm = {8, 3};
  ruler.tick_spacing_mm = 1;
  ruler.markers = {{{-4, -0.5}, 2.9, marker_cells(3)}, {{4, -0.5}, 2.9, marker_cells(4)}};
  for (const PlateShape& shape : {square, disc, ruler}) solids.push_back(make_plate(tilted, shape));
  solids.push_back(make_checkerboard(tilted, 1.5));
  solids.push_back(make_rod({-5, 1, 19}, {4, -2, 23}, 1.5, steel()));
  solids.push_back(make_rod({0, 0, 15}, {0.5, 0.5, 60}, 2.2, steel()));
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-0.6f, 0.6f);
  constexpr int kRays = 4000;
  std::vector<float> x(kRays), y(kRays), ground(kRays, 1e9f), depth(kRays), normal[3];
  std::vector<std::int32_t> part(kRays);
  for (auto& axis : normal) axis.resize(kRays);
  for (std::size_t i = 0; i < kRays; ++i) {
    x[i] = uniform(random);
    y[i] = uniform(random);
  }
  constexpr double kEdge = 0.002 / 790;  // px: of the standard scope in saline
  for (std::size_t s = 0; s < solids.size(); ++s) {
    std::fill(depth.begin(), depth.end(), 1e9f);
    std::fill(part.begin(), part.end(), 0);
    solids[s]->meet({x.data(), y.data(), ground.data()}, kRays, 5,
                    {depth.data(), part.data(), {normal[0].data(), normal[1].data(), normal[2].data()}});
    int differing = 0, met = 0;
    for (std::size_t i = 0; i < kRays; ++i) {
      const auto alone = [&](double dx, double dy, SolidHit& hit) {
        return solids[s]->hit({x[i] + dx, y[i] + dy, 1}, hit) ? 5 + hit.region : 0;
      };
      SolidHit hit, beside;
      const int expected = alone(0, 0, hit);
      met += expected != 0;
      if (part[i] != expected) {
        bool is_at_edge = false;
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
          is_at_edge = is_at_edge || alone(dx * kEdge, dy * kEdge, beside) == part[i];
        EXPECT_TRUE(is_at_edge) << s << ": " << x[i] << " " << y[i];
        ++differing;
      } else if (expected != 0) {
        EXPECT_NEAR(depth[i], hit.depth_mm, 2e-3) << s;
        EXPECT_NEAR((Vector3d(normal[0][i], normal[1][i], normal[2][i]) - hit.normal).norm(), 0, 3e-3) << s;
      }
    }
    EXPECT_GT(met, 50) << s;
    EXPECT_LT(differing, 5) << s;
  }
}

// What was met nearer, and what lies behind the bone, stays as it is; what yields may lie so far behind it.
TEST(Solids, LeaveWhatIsNearer) {
  const auto plate = make_plate(facing_at(20), {});
  std::vector<float> x(kTogether, 0.01f), y = x, depth{1e9f, 19, 21, 1e9f, 1e9f, 1e9f, 1e9f, 1e9f};
  std::vector<float> ground{1e9f, 1e9f, 1e9f, 19, 21, 17, 1e9f, 1e9f}, normal(kTogether, 0.0f);
  std::vector<std::int32_t> part(kTogether, 0);
  const auto meet = [&] {
    plate->meet({x.data(), y.data(), ground.data()}, kTogether, 1,
                {depth.data(), part.data(), {normal.data(), normal.data(), normal.data()}});
    return part;
  };
  EXPECT_EQ(meet(), (std::vector<std::int32_t>{1, 0, 1, 0, 1, 0, 1, 1}));
  plate->yields_mm = 2;
  EXPECT_EQ(meet(), (std::vector<std::int32_t>{1, 0, 1, 1, 1, 0, 1, 1}));
}

}  // namespace
}  // namespace arthronaut::simulator
