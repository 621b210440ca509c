#include "planning/plan_review/tunnel_verdict.h"

#include <gtest/gtest.h>

#include "planning/phantom/phantom_case.h"

namespace arthronaut::plan_review {
namespace {

using Verdict = tunnels::PlanCheck::Verdict;
constexpr bones::BoneKind kFemur = bones::BoneKind::Femur, kTibia = bones::BoneKind::Tibia;

TEST(TunnelVerdict, IsThatOfTheWorstCheck) {
  const tunnels::PlanCheck fine{.verdict = Verdict::Fine, .name = "Length", .text = "35.0 mm"},
      note{.verdict = Verdict::NotChecked, .name = "Roof", .text = "not checked"},
      look{.verdict = Verdict::Look, .name = "Diameter", .text = "7.0 mm: small"},
      wrong{.verdict = Verdict::Wrong, .name = "Wall", .text = "-3.5 mm"};
  EXPECT_TRUE(verdict_of(kFemur, {fine, note}, {}, "").is_fine());
  EXPECT_EQ(verdict_of(kFemur, {fine, note}, {}, "").in_short(), "");
  EXPECT_EQ(verdict_of(kFemur, {fine, look}, {}, "").worst(), Verdict::Look);
  EXPECT_EQ(verdict_of(kFemur, {fine, look}, {}, "").in_short(), "Diameter: 7.0 mm: small");
  const TunnelVerdict both =
      verdict_of(kFemur, {look, fine, wrong}, {{kFemur, {"the images end within it"}}}, "");
  EXPECT_EQ(both.worst(), Verdict::Wrong);
  EXPECT_EQ(both.in_short(), "Wall: -3.5 mm (and 2 to look at)") << "none of them is as bad";
  EXPECT_EQ(verdict_of(kFemur, {look, wrong, wrong}, {}, "").in_short(),
            "Wall: -3.5 mm (and 1 more wrong, 1 to look at)");
  EXPECT_EQ(verdict_of(kFemur, {wrong, wrong}, {}, "").in_short(), "Wall: -3.5 mm (and 1 more wrong)");
  EXPECT_EQ(verdict_of(kFemur, {look, look}, {}, "").in_short(), "Diameter: 7.0 mm: small (and 1 more)");
  EXPECT_EQ(both.look.front(), "Bone: the images end within it");
  EXPECT_EQ(verdict_of(kFemur, {}, {}, "landmarks missing: a").in_short(), "Grid: landmarks missing: a");
}

const cases::SideDoubt kOtherSide{.told = bones::Side::Left};

// A plan of the other knee is as wrong in the bone that nothing is known of as in the one that witnesses it.
TEST(TunnelVerdict, ASideInDoubtIsWrongForBothBones) {
  const cases::BoneDoubts doubts{{kTibia, {"the images end within it", kOtherSide}}};
  const TunnelVerdict femur = verdict_of(kFemur, {}, doubts, ""), tibia = verdict_of(kTibia, {}, doubts, "");
  EXPECT_EQ(femur.wrong, std::vector<std::string>{"Side: " + kOtherSide.words()});
  EXPECT_TRUE(femur.look.empty());
  EXPECT_EQ(tibia.wrong, femur.wrong);
  EXPECT_EQ(tibia.look, std::vector<std::string>{"Bone: the images end within it"}) << "and not twice";
}

// A tick that rests on the side is none while the side is in doubt; what is wrong stays wrong.
TEST(TunnelVerdict, WhileTheSideIsInDoubtNothingThatRestsOnItIsFine) {
  const std::vector<tunnels::PlanCheck> checks = {
      {.verdict = Verdict::Fine, .name = "Entry", .text = "on the lateral wall of the notch"},
      {.verdict = Verdict::Wrong, .name = "Exit", .text = "into the notch"},
      {.verdict = Verdict::Fine, .name = "Wall", .text = "4.0 mm"}};
  const auto doubted = as_side_is_doubted(checks, kOtherSide.words());
  EXPECT_EQ(doubted[0].verdict, Verdict::NotChecked);
  EXPECT_EQ(doubted[0].text, "not checked: the side is in doubt");
  EXPECT_EQ(doubted[1].verdict, Verdict::Wrong);
  EXPECT_EQ(doubted[2].verdict, Verdict::Fine) << "of no side";
  EXPECT_EQ(as_side_is_doubted(checks, "")[0].verdict, Verdict::Fine);
}

// What is of the knee is said once, what is of a tunnel with its name; landmarks that nobody confirmed, and
// a surface that the plan is not of, are said too.
TEST(TunnelVerdict, OfAPlanSaysEverythingOnce) {
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "Knee");
  CheckedPlan checks;
  for (const auto& [key, tunnel] : knee.plan.tunnels)
    checks[key] = {{.verdict = Verdict::Fine, .name = "Length", .text = "35.0 mm"}};
  EXPECT_TRUE(verdict_of_plan(knee, checks, {}).is_fine());
  knee.landmark_states[kFemur] = {};
  for (const auto& [name, at] : knee.landmarks.at(kFemur))
    knee.landmark_states[kFemur][name] = landmarks::LandmarkState::Proposed;
  knee.plan.mesh_sha256[{kTibia}] = std::string(64, 'a');
  const cases::BoneDoubts doubts{{kFemur, {kOtherSide}}, {kTibia, {kOtherSide}}};
  const TunnelVerdict plan = verdict_of_plan(knee, checks, doubts);
  ASSERT_EQ(plan.wrong.size(), 2U);
  EXPECT_EQ(plan.wrong[0], "Side: " + kOtherSide.words());
  EXPECT_TRUE(plan.wrong[1].starts_with("tibia: Bone: ")) << plan.wrong[1];
  EXPECT_EQ(plan.look, std::vector<std::string>{
                           "femur: Grid: landmarks proposed from the bone's shape, confirmed by nobody"});
}

}  // namespace
}  // namespace arthronaut::plan_review
