#include "planning/tunnels/tunnel_pair.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace arthronaut::tunnels {
namespace {

using Eigen::Vector3d;

struct Placed {
  Tunnel tunnel;
  TunnelGeometry measured;
};
Placed placed(const Vector3d& from, const Vector3d& direction, double length_mm, double diameter_mm) {
  return {{.entry_mm = from, .direction = direction.normalized(), .diameter_mm = diameter_mm},
          {.enters_bone = true,
           .entry_on_surface_mm = from,
           .exit_mm = from + length_mm * direction.normalized(),
           .length_mm = length_mm}};
}
double gap(const Placed& a, const Placed& b) {
  return gap_between(a.tunnel, a.measured, b.tunnel, b.measured).bone_mm;
}

TEST(TunnelPair, MeasuresParallelCrossingAndEndOnCylinders) {
  const Placed first = placed({0, 0, 0}, {0, 0, 1}, 30, 7);
  EXPECT_NEAR(gap(first, placed({9, 0, 5}, {0, 0, 1}, 40, 6)), 9 - 6.5, 1e-6);
  EXPECT_NEAR(gap(first, placed({-20, 8, 12}, {1, 0, 0}, 40, 6)), 8 - 6.5, 1e-6);
  EXPECT_NEAR(gap(first, placed({1, 0, 33}, {0, 0, 1}, 10, 6)), 3, 1e-6);  // one above the other
  EXPECT_NEAR(gap(first, placed({9, 0, 33}, {0, 0, 1}, 10, 6)), std::hypot(2.5, 3), 1e-4);  // rim to rim
}

// From a common mouth they diverge: what is left is least there. Into each other: by how much the axes are
// too near.
TEST(TunnelPair, SeesTunnelsRunIntoEachOther) {
  const Placed first = placed({0, 0, 0}, {0, 0, 1}, 30, 7);
  EXPECT_NEAR(gap(first, placed({-20, 4, 12}, {1, 0, 0}, 40, 6)), 4 - 6.5, 1e-6);
  EXPECT_NEAR(gap(first, placed({5, 0, 0}, {0.2, 0, 1}, 30, 6)), 5 - 6.5, 1e-6);
}

// Against points spread densely over both: a brute-force minimum is never less, and comes as near as its
// points stand.
TEST(TunnelPair, AgreesWithDenseSampling) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> spread(-1, 1);
  for (int i = 0; i < 6; ++i) {
    const Placed a = placed({0, 0, 0}, {0.3 * spread(random), 0.3 * spread(random), 1}, 25, 6),
                 b = placed({10 + 2 * spread(random), 3 * spread(random), 4 * spread(random)},
                            {0.4 * spread(random), 0.4 * spread(random), 1}, 25, 6);
    const auto points = [](const Placed& p) {
      std::vector<Vector3d> found;
      const Vector3d side = p.tunnel.direction.unitOrthogonal(), up = p.tunnel.direction.cross(side);
      for (int s = 0; s <= 100; ++s)
        for (int k = 0; k < 90; ++k)
          found.push_back(p.tunnel.entry_mm + 0.25 * s * p.tunnel.direction +
                          3 * (std::cos(k * 0.069813) * side + std::sin(k * 0.069813) * up));
      return found;
    };
    double least = 1e9;
    const auto of_b = points(b);
    for (const auto& p : points(a))
      for (const auto& q : of_b) least = std::min(least, (p - q).squaredNorm());
    EXPECT_LE(gap(a, b), std::sqrt(least) + 1e-6);
    EXPECT_NEAR(gap(a, b), std::sqrt(least), 0.06);
  }
}

}  // namespace
}  // namespace arthronaut::tunnels
