// Where the drill comes from, against rotations and distances that are written out here.
#include "planning/tunnels/portal.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::tunnels {
namespace {

using Eigen::Vector3d;

double deg(double rad) { return rad * 180 / std::acos(-1.0); }
double rad(double deg) { return deg * std::acos(-1.0) / 180; }

// Rodrigues' formula.
Vector3d turned(const Vector3d& p, const Vector3d& about, const Vector3d& axis, double angle) {
  const Vector3d v = p - about;
  return about + std::cos(angle) * v + std::sin(angle) * axis.cross(v) +
         (1 - std::cos(angle)) * axis.dot(v) * axis;
}

const graft::FlexionAxis kAxis{.point_mm = {3, -5, 8}, .direction = Vector3d(1, 0.1, -0.2).normalized()};
const Portal kPortal{.at_mm = {-20, -40, -12}, .radius_mm = 5};
constexpr double kDiameter_mm = 4;

// Each aim goes from where the turned tibia takes the skin to the entry; those of the rim lean by what its
// radius is seen under.
TEST(PortalAims, ComeFromThePortalThatTheTibiaTakesAlong) {
  const geometry::Surface far_off(test::ellipsoid({10, 10, 10}, 3, {500, 0, 0}));
  const Vector3d entry(-8, 12, 15);
  const auto aims = portal_aims(entry, kDiameter_mm, kPortal, kAxis, far_off);
  ASSERT_EQ(aims.size(), 7U * 9U);
  for (std::size_t i = 0; i < aims.size(); ++i) {
    const double flexion_deg = 100 + 5 * static_cast<double>(i / 9);
    EXPECT_NEAR(aims[i].flexion_deg, flexion_deg, 1e-9);
    EXPECT_TRUE(aims[i].is_clear);
    const Vector3d from = turned(kPortal.at_mm, kAxis.point_mm, kAxis.direction, rad(flexion_deg));
    const double leaning = deg(std::acos(std::min(1.0, aims[i].direction.dot((entry - from).normalized()))));
    const double rim = deg(std::atan(kPortal.radius_mm / (entry - from).norm()));
    EXPECT_NEAR(leaning, i % 9 == 0 ? 0 : rim, 1e-5) << i;
  }
}

// A ball in the way is in it where the drill's middle comes nearer to the ball's than both radii.
TEST(PortalAims, AreClearWhereNoBoneStandsInTheWay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-25, 25);
  constexpr double kBall_mm = 9, kUnsure_mm = 0.15;  // of the ball's facets and the drill's steps
  int clear = 0, barred = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Vector3d entry(-8, 12, 15);
    const Vector3d half_way = (entry + turned(kPortal.at_mm, kAxis.point_mm, kAxis.direction, rad(115))) / 2;
    const Vector3d ball = half_way + Vector3d(off(random), off(random), off(random));
    const geometry::Surface femur(test::ellipsoid({kBall_mm, kBall_mm, kBall_mm}, 4, ball));
    for (const PortalAim& aim : portal_aims(entry, kDiameter_mm, kPortal, kAxis, femur)) {
      const Vector3d middle = turned(kPortal.at_mm, kAxis.point_mm, kAxis.direction, rad(aim.flexion_deg));
      const double along = (entry - middle).dot(aim.direction);
      const double length = std::abs(along - (entry - middle).norm()) < 1e-9
                                ? (entry - middle).norm()
                                : std::hypot((entry - middle).norm(), kPortal.radius_mm);
      const double last = length - 3 - kDiameter_mm / 2;  // before the entry, where the drill meets the bone
      const Vector3d from = entry - length * aim.direction;
      const double nearest_at = std::clamp((ball - from).dot(aim.direction), 0.0, last);
      const double apart = (from + nearest_at * aim.direction - ball).norm() - kBall_mm - kDiameter_mm / 2;
      if (std::abs(apart) < kUnsure_mm) continue;
      EXPECT_EQ(aim.is_clear, apart > 0) << "trial " << trial << ", " << apart << " mm apart";
      (apart > 0 ? clear : barred) += 1;
    }
  }
  EXPECT_GT(clear, 100);
  EXPECT_GT(barred, 100);
}

// The angle to the nearest way that is clear; one that is not does not count, however near it is.
TEST(PortalAims, TellHowFarADirectionIsOffThem) {
  const Vector3d planned = Vector3d(1, 2, -1).normalized(), across = planned.unitOrthogonal();
  const auto aim = [&](double off_deg, bool is_clear) {
    return PortalAim{.direction = std::cos(rad(off_deg)) * planned + std::sin(rad(off_deg)) * across,
                     .is_clear = is_clear};
  };
  EXPECT_NEAR(off_portal_deg(planned, {aim(0, false), aim(-11, true), aim(7, true)}), 7, 1e-6);
  EXPECT_EQ(off_portal_deg(planned, {aim(0, false)}), 180);
}

}  // namespace
}  // namespace arthronaut::tunnels
