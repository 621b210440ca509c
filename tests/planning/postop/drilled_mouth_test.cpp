// Where a line enters a bone, and how far off that is where the line is a little aside.
#include "planning/postop/drilled_mouth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planning/phantom/phantom_knee.h"

namespace arthronaut::postop {

// What was said of an entry was what its axis is off across itself: where the surface slants that is too
// little. Limit: a tenth, what 2000 draws leave open of a ratio of up to 2.3 between curved and flat.
TEST(Passage, AnEntryIsOffByMoreThanItsAxisWhereTheSurfaceSlants) {
  const auto knee = phantom::make_phantom_knee({.edge_length_mm = 2});
  const geometry::Surface bone(knee.tibia.mesh);
  const tunnels::Tunnel& plan = knee.tibial_tunnel;
  std::mt19937_64 random(1);
  constexpr double kSigma_mm = 0.05;
  std::normal_distribution<double> normal(0, kSigma_mm * M_SQRT1_2);
  for (const double tilt_rad : {-0.5, 0.0, 0.5}) {
    const Eigen::Vector3d aside = plan.direction.unitOrthogonal(),
                          d = std::cos(tilt_rad) * plan.direction + std::sin(tilt_rad) * aside,
                          u = d.unitOrthogonal(), v = d.cross(u);
    const auto passage = passage_of(bone, plan.entry_mm, d);
    ASSERT_TRUE(passage);
    double squares = 0;
    int count = 0;
    for (int draw = 0; draw < 2000; ++draw) {
      const auto other = passage_of(bone, passage->entry_mm + normal(random) * u + normal(random) * v, d);
      ASSERT_TRUE(other);
      squares += (other->entry_mm - passage->entry_mm).squaredNorm();
      ++count;
    }
    const double times = std::sqrt(squares / count) / kSigma_mm;
    EXPECT_NEAR(passage->entry_per_across() / times, 1, 0.1) << tilt_rad << ": " << times;
    EXPECT_GE(passage->entry_per_across(), 1);
  }
}

}  // namespace arthronaut::postop
