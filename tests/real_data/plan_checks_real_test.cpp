// What planning measures on a real femur and tibia, against rays cast one by one.
#include <gtest/gtest.h>

#include <random>

#include "planning/bones/mesh_file.h"
#include "planning/tunnels/tunnel.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/planning/tunnels/dense_wall.h"
#include "tests/real_data/real_data.h"

namespace arthronaut {
namespace {

using Eigen::Vector3d;

// The file's axes are anterior, superior, right; ours left, posterior, superior.
Eigen::Matrix3d lps_from_file() {
  Eigen::Matrix3d turn;
  turn << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  return turn;
}

geometry::Surface read_bone(const std::filesystem::path& file) {
  return geometry::Surface(
      test::moved(bones::read_mesh(file, {.space = {}, .unit = bones::LengthUnit::Metre}), lps_from_file(),
                  Vector3d::Zero()));
}

// Tunnels through the true footprint in many directions. Nowhere on a coarse grid of rays over the whole
// tunnel is there less bone than was measured, and a fine grid about the place that was shown finds as
// little; either to 0.02 mm. The 1 mm for which a face must turn away to end a lip are told by rays to two of
// their steps.
TEST(RealWall, AgreesWithDenseSampling) {
  ARTHRONAUT_REQUIRE_DATA(folder, "bones/lenhart2015");
  const geometry::Surface femur = read_bone(folder / "lenhart2015-R-femur-bone.stl");
  const Vector3d footprint = lps_from_file() * Vector3d(-0.5, 0.5, 5.0);  // the middle of the 12 strands
  std::mt19937 random(1);
  std::normal_distribution<double> turn(0, 0.15);
  int measured_tunnels = 0;
  for (int i = 0; i < 8; ++i) {
    tunnels::Tunnel tunnel{.diameter_mm = 9};
    tunnel.entry_mm = femur.closest_point(footprint + 1.5 * Vector3d(0, i % 5 - 2, i % 3 - 1)).point_mm;
    tunnel.direction = Vector3d(-0.72 + turn(random), -0.32 + turn(random), 0.62 + turn(random)).normalized();
    const auto measured = tunnels::measure(tunnel, femur);
    if (!measured.enters_bone) continue;
    ++measured_tunnels;
    const double angle = test::angle_of(tunnel, measured, measured.thinnest_mm);
    const auto coarse = test::dense_wall(tunnel, measured, femur,
                                         {.count = 72, .step_mm = 0.1, .roughness_mm = 1.2}),
               fine = test::dense_wall(tunnel, measured, femur,
                                       {.from_rad = angle - 0.0001,
                                        .to_rad = angle + 0.0001,
                                        .count = 2,
                                        .step_mm = 0.0008,
                                        .roughness_mm = 0.99});
    EXPECT_GT(coarse.thickness_mm, measured.wall_mm - 0.02) << i;
    EXPECT_LT(fine.thickness_mm, measured.wall_mm + 0.02) << i;
  }
  EXPECT_GE(measured_tunnels, 6);
}

}  // namespace
}  // namespace arthronaut
