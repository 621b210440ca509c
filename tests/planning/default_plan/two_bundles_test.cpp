// A default plan of a ligament's two bundles.
#include <gtest/gtest.h>

#include <algorithm>

#include "planning/files/format.h"
#include "planning/norms/footprint.h"
#include "planning/tunnels/diameter_range.h"
#include "planning/tunnels/plan_norms.h"
#include "planning/tunnels/tunnel_pair.h"
#include "tests/planning/default_plan/knee_inputs.h"

namespace arthronaut::default_plan {
namespace {

using bones::BoneKind;
using bones::Side;
using norms::Bundle;
using test::Knee;
using test::knee_of;

// Of the posterolateral tunnel that is planned first and the anteromedial one beside it, as much bone is left
// as the plan's own check asks for, and the same the other way round: nobody has to know which comes first.
TEST(TwoBundles, KeepsBoneBetweenTwoBundlesInEitherOrder) {
  for (const Side side : {Side::Left, Side::Right}) {
    const Knee& knee = knee_of(side);
    for (BoneInput input : knee.inputs(true)) {
      SCOPED_TRACE(bones::to_text(input.bone->kind));
      const auto planned = [&](Bundle bundle, const tunnels::Tunnel* beside) {
        input.beside = beside;
        return plan_bone(input, side, {.bundle = bundle, .diameter_mm = tunnels::usual_diameter_mm(bundle)});
      };
      for (const auto& [one, other] : {std::pair(Bundle::Anteromedial, Bundle::Posterolateral),
                                       std::pair(Bundle::Posterolateral, Bundle::Anteromedial)}) {
        const auto first = planned(one, nullptr), second = planned(other, &first.tunnel);
        ASSERT_TRUE(first.is_usable() && second.is_usable());
        EXPECT_GE(tunnels::gap_between(first.tunnel, tunnels::measure(first.tunnel, *input.surface),
                                       second.tunnel, tunnels::measure(second.tunnel, *input.surface))
                      .bone_mm,
                  tunnels::PlanNorms{}.thin_bone_between_tunnels_mm)
            << norms::to_text(one) << " first";
      }
    }
  }
}

// Bundles of 7 and 6 mm are too thick for the places of the norms; thin ones stay where the norm has them.
// What is moved stays within one sigma of the norm, on the line through both, and says so.
TEST(TwoBundles, MovesBundlesApartWithinTheirSpreadAndSaysSo) {
  const Knee& knee = knee_of(Side::Right);
  int bundles_moved = 0;
  for (const BoneInput& input : knee.inputs(true)) {
    for (const Bundle bundle : {Bundle::Anteromedial, Bundle::Posterolateral}) {
      SCOPED_TRACE(norms::to_text(bundle));
      const auto kind = input.bone->kind;
      const auto expected = norms::expected_footprint(input.bone->mesh, *input.surface, kind, Side::Right,
                                                      input.landmarks, norms::default_norm(kind, bundle));
      ASSERT_TRUE(expected);
      const auto planned = plan_bone(input, Side::Right,
                                     {.bundle = bundle, .diameter_mm = tunnels::usual_diameter_mm(bundle)});
      ASSERT_TRUE(planned.is_usable());
      const double off_mm = (planned.tunnel.entry_mm - expected->center_mm).norm();
      EXPECT_EQ(planned.off_norm_mm, off_mm);
      EXPECT_EQ(planned.source.ends_with(", customary"), kind == BoneKind::Tibia) << "as the checks say it";
      double spread_mm = 0;
      for (const auto& at : expected->spread_mm)
        spread_mm = std::max(spread_mm, (at - expected->center_mm).norm());
      EXPECT_LE(off_mm, spread_mm);
      EXPECT_TRUE(off_mm == 0 || bundle == Bundle::Posterolateral);
      bundles_moved += off_mm > 0 ? 1 : 0;
      // Thin ones have bone enough between them at the norms.
      const Bundle of_other = bundle == Bundle::Anteromedial ? Bundle::Posterolateral : Bundle::Anteromedial;
      tunnels::Tunnel needle =
          plan_bone(input, Side::Right,
                    {.bundle = of_other, .diameter_mm = tunnels::usual_diameter_mm(of_other)})
              .tunnel;
      const double between_mm =
          tunnels::gap_between(planned.tunnel, tunnels::measure(planned.tunnel, *input.surface), needle,
                               tunnels::measure(needle, *input.surface))
              .bone_mm;
      const std::string moved =
          files::format("%.1f mm off the norm's place, away from the tunnel %s AM, for ", off_mm,
                        std::string(bones::to_text(kind)).c_str()) +
          files::format("%.1f mm of bone between the two: 1.", between_mm);
      EXPECT_EQ(planned.place.substr(0, moved.size()), off_mm > 0 ? moved : "at the norm's place");
      needle.diameter_mm = 3;
      BoneInput thin = input;
      thin.beside = &needle;
      const auto beside_thin = plan_bone(thin, Side::Right, {.bundle = bundle, .diameter_mm = 3});
      ASSERT_TRUE(beside_thin.is_usable());
      EXPECT_EQ(beside_thin.tunnel.entry_mm, expected->center_mm);
      EXPECT_EQ(beside_thin.place, "at the norm's place");
    }
  }
  EXPECT_GE(bundles_moved, 1) << "on one bone at least the norms' places are too near";
}

// A tunnel of the other bundle that misses the bone, as after a move of the landmarks or by another program:
// nothing is there to make room for.
TEST(TwoBundles, MakesNoRoomForATunnelThatMissesTheBone) {
  const Knee& knee = knee_of(Side::Right);
  for (BoneInput input : knee.inputs(true)) {
    const auto kind = input.bone->kind;
    const auto expected =
        norms::expected_footprint(input.bone->mesh, *input.surface, kind, Side::Right, input.landmarks,
                                  norms::default_norm(kind, Bundle::Posterolateral));
    ASSERT_TRUE(expected);
    const tunnels::Tunnel missing{
        .bone = kind,
        .entry_mm = expected->center_mm + 300 * expected->normal,
        .direction = expected->normal,
        .diameter_mm = 700,  // so thick that only a bone it enters is out of its way
        .bundle = Bundle::Anteromedial};
    input.beside = &missing;
    const auto planned = plan_bone(input, Side::Right, {.bundle = Bundle::Posterolateral, .diameter_mm = 6});
    ASSERT_TRUE(planned.is_usable());
    EXPECT_EQ(planned.tunnel.entry_mm, expected->center_mm) << planned.source;
  }
}

}  // namespace
}  // namespace arthronaut::default_plan
