#include "planning/plan_review/tunnel_verdict.h"

#include <gtest/gtest.h>

namespace arthronaut::plan_review {
namespace {

using Verdict = tunnels::PlanCheck::Verdict;

TEST(TunnelVerdict, IsThatOfTheWorstCheck) {
  const tunnels::PlanCheck fine{.verdict = Verdict::Fine, .name = "Length", .text = "35.0 mm"},
      note{.verdict = Verdict::NotChecked, .name = "Roof", .text = "not checked"},
      look{.verdict = Verdict::Look, .name = "Diameter", .text = "7.0 mm: small"},
      wrong{.verdict = Verdict::Wrong, .name = "Wall", .text = "-3.5 mm"};
  EXPECT_TRUE(verdict_of({fine, note}, {}, "").is_fine());
  EXPECT_EQ(verdict_of({fine, note}, {}, "").in_short(), "");
  EXPECT_EQ(verdict_of({fine, look}, {}, "").worst(), Verdict::Look);
  EXPECT_EQ(verdict_of({fine, look}, {}, "").in_short(), "Diameter: 7.0 mm: small");
  const TunnelVerdict both = verdict_of({look, fine, wrong}, {"check the side"}, "");
  EXPECT_EQ(both.worst(), Verdict::Wrong);
  EXPECT_EQ(both.in_short(), "Wall: -3.5 mm (and 2 to look at)") << "none of them is as bad";
  EXPECT_EQ(verdict_of({look, wrong, wrong}, {}, "").in_short(),
            "Wall: -3.5 mm (and 1 more wrong, 1 to look at)");
  EXPECT_EQ(verdict_of({wrong, wrong}, {}, "").in_short(), "Wall: -3.5 mm (and 1 more wrong)");
  EXPECT_EQ(verdict_of({look, look}, {}, "").in_short(), "Diameter: 7.0 mm: small (and 1 more)");
  EXPECT_EQ(both.look.front(), "Bone: check the side");
  EXPECT_EQ(verdict_of({}, {}, "landmarks missing: a").in_short(), "Grid: landmarks missing: a");
}

}  // namespace
}  // namespace arthronaut::plan_review
