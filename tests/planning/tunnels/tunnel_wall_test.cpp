#include "planning/tunnels/tunnel_wall.h"

#include <gtest/gtest.h>

#include <random>

#include "planning/tunnels/tunnel.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/planning/tunnels/dense_wall.h"

namespace arthronaut::tunnels {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// What a planner may rely on: figures of the wall are right to this.
constexpr double kExact_mm = 0.02;

double wall_of(const geometry::TriangleMesh& bone, const Vector3d& entry, const Vector3d& direction,
               double diameter) {
  const auto measured =
      measure({.entry_mm = entry, .direction = direction.normalized(), .diameter_mm = diameter},
              geometry::Surface(bone));
  EXPECT_TRUE(measured.enters_bone);
  return measured.wall_mm;
}

// A condyle's back edge: square on, and 3 mm beneath the mouth the bone draws back to 2.75 mm from the axis,
// then swells again. 9 mm wide, the tunnel is 1.75 mm outside there.
geometry::TriangleMesh undercut() {
  return test::prism({{5.5, 0}, {2.75, 3}, {25, 30}, {-40, 30}, {-40, 0}}, 40, {-10, 10});
}

// It was left out: the wall began one diameter beneath the mouth.
TEST(TunnelWall, BeginsAtTheMouth) {
  const geometry::Surface bone(undercut());
  const auto measured = measure({.entry_mm = {0, 0, 0}, .direction = {0, 0, 1}, .diameter_mm = 9}, bone);
  ASSERT_TRUE(measured.enters_bone);
  EXPECT_NEAR(measured.wall_mm, -1.75, 1e-3);
  EXPECT_NEAR(measured.thinnest_station_mm, 3, 0.01);
  EXPECT_LT((measured.thinnest_mm - Vector3d(0, 2.75, 3)).norm(), 0.02);
}

// A wider drill leaves less bone, by the half of what it is wider: it never takes the warning away.
TEST(TunnelWall, ThinsAsTheTunnelWidens) {
  for (double diameter = 4; diameter <= 12; diameter += 0.5)
    EXPECT_NEAR(wall_of(undercut(), {0, 0, 0}, {0, 0, 1}, diameter), 2.75 - diameter / 2, 1e-3) << diameter;
}

// Square on and beside an edge: the distance to the side face, whatever the diameter.
TEST(TunnelWall, ReadsTheTruthSquareOn) {
  for (const double diameter : {6.0, 8.0, 9.0, 10.0, 12.0}) {
    for (const double to_edge : {2.0, 5.0, 6.5, 8.0, 12.0, 25.0}) {
      EXPECT_NEAR(wall_of(test::box({50, 30, 20}), {3, 30 - to_edge, -20}, {0, 0, 1}, diameter),
                  to_edge - diameter / 2, 1e-3)
          << diameter << " " << to_edge;
    }
  }
}

// Along a round bone, off its middle.
TEST(TunnelWall, ReadsTheTruthInACylinder) {
  const auto bone = test::cylinder(20, 30, 720);
  for (const double off : {0.0, 4.0, 9.0, 13.0, 16.0}) {
    for (const double diameter : {8.0, 10.0}) {
      EXPECT_NEAR(wall_of(bone, {0.6 * off, 0.8 * off, -30}, {0, 0, 1}, diameter), 20 - off - diameter / 2,
                  kExact_mm)
          << off << " " << diameter;
    }
  }
}

// A slanting mouth has a sharp lip and no breach: the wall is that to the side faces, 26 mm off the axis.
TEST(TunnelWall, TellsASlantingMouthFromABreach) {
  for (const double slant_deg : {5.0, 20.0, 35.0, 50.0, 62.0}) {
    const double slant = geometry::rad_from_deg(slant_deg);
    EXPECT_NEAR(wall_of(test::box({200, 30, 20}), {-20, 4, -20}, {std::sin(slant), 0, std::cos(slant)}, 9),
                26 - 4.5, 0.02)
        << slant_deg;
  }
}

// So slanting that it is a groove.
TEST(TunnelWall, CallsAGrazingTunnelABreach) {
  const double slant = geometry::rad_from_deg(78);
  EXPECT_LT(wall_of(test::box({400, 30, 20}), {-100, 4, -20}, {std::sin(slant), 0, std::cos(slant)}, 9), 0.1);
}

// The thinnest place of a slanting rim lies before the axis has entered: 1 in 2 towards +y, the rim on the
// other side begins 4.5 * 0.5 mm earlier, and from there the line straight away from the axis meets the face
// y = -30.
TEST(TunnelWall, LooksAtTheRimBeforeTheAxisEnters) {
  const Vector3d direction = Vector3d(0, 0.5, 1).normalized();
  const double to_face = 7, station = -4.5 * 0.5;
  const Vector3d rim = Vector3d(0, -30 + to_face, -20) + station * direction;
  const double cosine = direction.z();  // of the line that runs away from the axis, against -y
  const double truth = (rim.y() + 30) / cosine - 4.5;
  EXPECT_NEAR(wall_of(test::box({50, 30, 20}), {0, -30 + to_face, -20}, direction, 9), truth, kExact_mm);
}

// Out over the edge of the far face: the side shows through a face that is not the exit's.
TEST(TunnelWall, SeesTheSideShowThroughASecondFace) {
  EXPECT_LT(wall_of(test::box({50, 30, 20}), {0, 8, -20}, {0, 0.5, 1}, 9), 0);
  EXPECT_GT(wall_of(test::box({50, 30, 20}), {0, -8, -20}, {0, 0.5, 1}, 9), 8);
}

// The back wall of a condyle: the mouth's face ends at an edge, and the cortex behind it runs away from the
// axis at 18 deg. The rim between mouth and edge is the wall.
TEST(TunnelWall, TakesTheRimBesideABackCortex) {
  const double away = std::tan(geometry::rad_from_deg(18));
  for (const double rim : {-1.0, 0.5, 2.5}) {
    const double edge = 4.5 + rim;
    const auto bone = test::prism({{edge, 0}, {edge + 40 * away, 40}, {-40, 40}, {-40, 0}}, 40, {-10, 20});
    EXPECT_NEAR(wall_of(bone, {0, 0, 0}, {0, 0, 1}, 9), rim, kExact_mm);
  }
}

// A groove that ends in an edge beside the tunnel: in a half plane on one side of the edge its flank lies 2
// mm further off than the edge, on the other side nothing is near. Wherever the edge stands between the half
// planes, it is the thinnest place, and not the even wall of 1.5 mm on the other side.
TEST(TunnelWall, FindsTheEdgeThatTheThicknessLeapsAt) {
  // The flank runs off by 0.4 mm a degree, and half planes stand 0.1 deg apart.
  constexpr double kBeside_mm = 0.04;
  const Vector2d edge(5.03, 0.923);
  for (double turn_deg = 0; turn_deg < 3; turn_deg += 0.25) {
    const double turn = geometry::rad_from_deg(turn_deg), cosine = std::cos(turn), sine = std::sin(turn);
    const auto turned = [&](const Vector2d& p) {
      return Vector2d(cosine * p.x() - sine * p.y(), sine * p.x() + cosine * p.y());
    };
    const auto bone = test::prism({turned({-6, -20}), turned({40, -20}), turned({40, -0.7}), turned(edge),
                                   turned({40, 3}), turned({40, 20}), turned({-6, 20})},
                                  20, turned({-5, 0.9}));
    EXPECT_NEAR(wall_of(bone, {-20, 0, 0}, {1, 0, 0}, 9), edge.norm() - 4.5, kBeside_mm) << turn_deg;
  }
}

// The same tunnel in the same bone, turned and shifted.
TEST(TunnelWall, IsTheSameHoweverTheBoneLies) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto bone = undercut();
  const Vector3d entry(4, -1, 0), direction = Vector3d(0.2, -0.1, 1).normalized();
  const double truth = wall_of(bone, entry, direction, 9);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
            .normalized()
            .matrix();
    const Vector3d shift(30 * normal(random), 30 * normal(random), 30 * normal(random));
    // The half planes stand elsewhere: exact to what they are refined to.
    EXPECT_NEAR(wall_of(test::moved(bone, turn, shift), turn * entry + shift, turn * direction, 9), truth,
                kExact_mm);
  }
}

// Against rays cast one by one, on a bowed bone with many faces. The rays stand 0.05 mm and 2 deg apart:
// where a lip ends on a face at 45 deg, they are off by a step.
TEST(TunnelWall, AgreesWithDenseSampling) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> off(-14, 14), slant(-0.5, 0.5);
  const geometry::Surface bone(test::ellipsoid({30, 24, 20}, 4));
  int compared = 0;
  for (int i = 0; i < 8; ++i) {
    Tunnel tunnel{.direction = Vector3d(slant(random), slant(random), 1).normalized(), .diameter_mm = 9};
    tunnel.entry_mm = bone.closest_point({off(random), off(random), -30}).point_mm;
    const auto measured = measure(tunnel, bone);
    if (!measured.enters_bone) continue;
    const auto dense = test::dense_wall(tunnel, measured, bone, {.count = 180, .step_mm = 0.05});
    EXPECT_NEAR(measured.wall_mm, dense.thickness_mm, 0.05) << i;
    ++compared;
  }
  EXPECT_GE(compared, 5);
}

}  // namespace
}  // namespace arthronaut::tunnels
