#include "planning/postop/socket_end.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "planning/geometry/quantile.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/planning/postop/postop_ct.h"

namespace arthronaut::postop {
namespace {

struct Seen {
  std::optional<double> end_mm;
  double sigma_mm = 0;
};

// A socket of 22 mm in a block of marrow of 150 HU with grain of 35 HU.
Seen seen(double graft_hu, std::uint64_t seed, double narrow_mm = 0) {
  constexpr double kDiameter_mm = 9, kMarrow_hu = 150;
  const auto mesh = test::box({19, 19, 24});
  const geometry::Surface bone(mesh);
  test::KnownCtOptions ct = test::half_fine();
  ct.margin_mm = 3;
  ct.marrow_hu = kMarrow_hu;
  ct.seed = seed;
  ct.operate = test::uneven_marrow(kMarrow_hu, 35, 1.2, seed);
  test::Drilled how;
  how.tunnel = {.entry_mm = {1, -2, -24},
                .direction = Eigen::Vector3d(0.1, 0.05, 1).normalized(),
                .diameter_mm = kDiameter_mm};
  if (narrow_mm > 0) {
    how.narrow_from_mm = 22;
    how.narrow_mm = narrow_mm;
  } else {
    how.to_mm = 22;
  }
  how.content_hu = graft_hu;
  const geometry::RigidTransform stays;
  const auto volume = test::postop_ct({mesh}, {how}, stays, ct);
  const images::VolumeSampler sampler(volume);
  const AlongBore bore(sampler, stays, bone, *passage_of(bone, how.tunnel.entry_mm, how.tunnel.direction),
                       0.5 * kDiameter_mm, kMarrow_hu - graft_hu, 0.45);
  const TellingRing ring = narrow_mm > 0 ? TellingRing{0.5 * narrow_mm + 0.6, 0.5 * kDiameter_mm - 0.2}
                                         : middle_of(0.5 * kDiameter_mm);
  Seen result{bore.end_mm(ring)};
  if (result.end_mm) result.sigma_mm = bore.end_sigma_mm(ring, *result.end_mm);
  return result;
}

TEST(SocketEnd, OfAGraftThatStandsOutIsKnown) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Seen end = seen(50, seed);
    ASSERT_TRUE(end.end_mm);
    EXPECT_NEAR(*end.end_mm, 22, 0.4);
    EXPECT_LT(end.sigma_mm, 0.75);
  }
}

// Marrow a little darker or brighter at the end moves the place half-way up, within the blur.
TEST(SocketEnd, IsOffByAsMuchAsIsSaidBesideAThinnerBore) {
  constexpr std::uint64_t kSockets = 8;
  double squares = 0;
  std::vector<double> said_mm;
  for (std::uint64_t seed = 1; seed <= kSockets; ++seed) {
    const Seen end = seen(60, seed, 4.5);
    ASSERT_TRUE(end.end_mm);
    squares += std::pow(*end.end_mm - 22, 2);
    said_mm.push_back(end.sigma_mm);
  }
  const double off_mm = std::sqrt(squares / static_cast<double>(kSockets)),
               said = geometry::median(std::move(said_mm));
  EXPECT_LT(off_mm, 2 * said);
  EXPECT_GT(off_mm, 0.5 * said);
}

// Where the marrow beyond is by chance as dark as the graft, the socket looks longer than it is by
// millimetres.
TEST(SocketEnd, OfAFaintGraftIsKnownAsBadlyAsItIs) {
  int too_long = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Seen end = seen(115, seed);
    if (!end.end_mm || std::abs(*end.end_mm - 22) < 1) continue;
    ++too_long;
    EXPECT_GT(end.sigma_mm, 0.75) << *end.end_mm;
  }
  EXPECT_GT(too_long, 0);
}

}  // namespace
}  // namespace arthronaut::postop
