#include "planning/plan_review/tunnel_verdict.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "planning/phantom/phantom_case.h"

namespace arthronaut::plan_review {
namespace {

using Verdict = tunnels::PlanCheck::Verdict;
constexpr bones::BoneKind kFemur = bones::BoneKind::Femur, kTibia = bones::BoneKind::Tibia;
const tunnels::Tunnel kOfFemur{.bone = kFemur, .diameter_mm = 9}, kOfTibia{.bone = kTibia, .diameter_mm = 9};

TEST(TunnelVerdict, IsThatOfTheWorstCheck) {
  const tunnels::PlanCheck fine{.verdict = Verdict::Fine, .name = "Length", .text = "35.0 mm"},
      note{.verdict = Verdict::NotChecked, .name = "Roof", .text = "not checked"},
      look{.verdict = Verdict::Look, .name = "Diameter", .text = "7.0 mm: small"},
      wrong{.verdict = Verdict::Wrong, .name = "Wall", .text = "-3.5 mm"};
  EXPECT_TRUE(verdict_of(kOfFemur, {fine, note}, {}, "").is_fine());
  EXPECT_EQ(verdict_of(kOfFemur, {fine, note}, {}, "").in_short(), "");
  EXPECT_EQ(verdict_of(kOfFemur, {fine, look}, {}, "").worst(), Verdict::Look);
  EXPECT_EQ(verdict_of(kOfFemur, {fine, look}, {}, "").in_short(), "Diameter: 7.0 mm: small");
  const TunnelVerdict both =
      verdict_of(kOfFemur, {look, fine, wrong}, {{kFemur, {"the images end within it"}}}, "");
  EXPECT_EQ(both.worst(), Verdict::Wrong);
  EXPECT_EQ(both.in_short(), "Wall: -3.5 mm (and 2 to look at)") << "none of them is as bad";
  EXPECT_EQ(verdict_of(kOfFemur, {look, wrong, wrong}, {}, "").in_short(),
            "Wall: -3.5 mm (and 1 more wrong, 1 to look at)");
  EXPECT_EQ(verdict_of(kOfFemur, {wrong, wrong}, {}, "").in_short(), "Wall: -3.5 mm (and 1 more wrong)");
  EXPECT_EQ(verdict_of(kOfFemur, {look, look}, {}, "").in_short(), "Diameter: 7.0 mm: small (and 1 more)");
  EXPECT_EQ(both.look.front(), "Bone: the images end within it");
  EXPECT_EQ(verdict_of(kOfFemur, {}, {}, "landmarks missing: a").in_short(), "Grid: landmarks missing: a");
}

const cases::SideDoubt kOtherSide{.told = bones::Side::Left};

// A plan of the other knee is as wrong in the bone that nothing is known of as in the one that witnesses it.
TEST(TunnelVerdict, ASideInDoubtIsWrongForBothBones) {
  const cases::BoneDoubts doubts{{kTibia, {"the images end within it", kOtherSide}}};
  const TunnelVerdict femur = verdict_of(kOfFemur, {}, doubts, ""),
                      tibia = verdict_of(kOfTibia, {}, doubts, "");
  EXPECT_EQ(femur.wrong, std::vector<std::string>{"Side: " + kOtherSide.words()});
  EXPECT_TRUE(femur.look.empty());
  EXPECT_EQ(tibia.wrong, femur.wrong);
  EXPECT_EQ(tibia.look, std::vector<std::string>{"Bone: the images end within it"}) << "and not twice";
}

// A side that a person alone said speaks against nothing, and is not lost.
TEST(TunnelVerdict, ASideThatWasOnlySaidIsANoteAndNoDoubt) {
  const cases::SideDoubt said{cases::SideWitness::PersonAlone, bones::Side::Left, bones::Side::Left};
  const cases::BoneDoubts doubts{{kTibia, {said}}};
  EXPECT_EQ(side_doubt(doubts), "");
  EXPECT_EQ(side_note(doubts), said.words());
  for (const tunnels::Tunnel& tunnel : {kOfFemur, kOfTibia}) {
    EXPECT_TRUE(verdict_of(tunnel, {}, doubts, "").is_fine());
    EXPECT_EQ(verdict_of(tunnel, {}, doubts, "").side_note, said.words());
  }
  EXPECT_TRUE(verdict_of_bones(doubts).is_fine());
  EXPECT_EQ(side_note({{kTibia, {"cut off", kOtherSide}}}), "");
}

// Without a plan: what was said of the bones when they were made.
TEST(TunnelVerdict, BonesWithoutAPlanAreAsDoubtfulAsTheyWereMade) {
  const TunnelVerdict verdict =
      verdict_of_bones({{kFemur, {"the images end within it"}}, {kTibia, {kOtherSide}}});
  EXPECT_EQ(verdict.wrong, std::vector<std::string>{"Side: " + kOtherSide.words()});
  EXPECT_EQ(verdict.look, std::vector<std::string>{"femur: Bone: the images end within it"});
  EXPECT_TRUE(verdict_of_bones({}).is_fine());
}

// Where a hole was filled in, or the images end, nobody has seen bone: an entry there is wrong, one beside it
// is not. Its mouth counts, not only its middle.
TEST(TunnelVerdict, AnEntryWhereNobodyHasSeenBoneIsToldFromOneBesideIt) {
  const auto entry_at = [](double x_mm, bones::UnseenParts unseen) {
    tunnels::Tunnel tunnel = kOfFemur;
    tunnel.entry_mm = {x_mm, 0, 0};
    tunnels::PlanSurroundings known;
    known.unseen = std::move(unseen);
    const auto checks = tunnels::check_plan(
        tunnel, {.enters_bone = true, .exit_mm = {-40, 0, 0}, .length_mm = 35, .wall_mm = 5}, known);
    const TunnelVerdict verdict = verdict_of(tunnel, checks, {}, "");
    return verdict.wrong.empty() ? "" : verdict.wrong.front();
  };
  const bones::UnseenParts hole{.filled_holes = {{.at_mm = {10, 0, 0}, .across_mm = 12}}};
  for (const double x_mm : {10.0, 15.0, 20.0})  // up to 6 mm of hole and 4.5 mm of mouth from its middle
    EXPECT_EQ(entry_at(x_mm, hole),
              "Entry: it reaches a hole about 12 mm across that was filled in when the bone was made: nobody "
              "has seen bone there");
  EXPECT_EQ(entry_at(20.6, hole), "");
  const bones::UnseenParts cut{.image_cuts = {{.at_mm = {10, 0, 0}, .out = {1, 0, 0}, .area_mm2 = 500}}};
  for (const double x_mm : {11.0, 5.6})  // its mouth of 9 mm reaches there
    EXPECT_EQ(entry_at(x_mm, cut), "Entry: it reaches where the images end: nobody has seen bone there");
  EXPECT_EQ(entry_at(5.4, cut), "");
}

// A tunnel that leaves where the images end goes on through bone that nobody has seen: what asks where it
// leaves the bone is not checked, and the graft is no shorter than what was seen of it. Of the other bone,
// and of the same tunnel where the images go on beyond its exit, everything is as it was.
TEST(TunnelVerdict, Hazard46ATunnelThatLeavesWhereTheImagesEndIsNotChecked) {
  const cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "Knee");
  const CaseReview whole(knee);
  using Names = std::vector<std::string>;
  const std::map<bones::BoneKind, Names> of_the_exit = {
      {kFemur, {"Length", "Exit", "Lateral epicondyle", "Posterior cortex"}},
      {kTibia, {"Length", "Exit", "Tuberosity"}}};
  for (const auto& [bone, names] : of_the_exit) {
    const tunnels::TunnelGeometry& measured = whole.tunnels().at(bone).geometry;
    const auto cut_off = [&, kind = bone](double beyond_exit_mm) {
      const Eigen::Vector3d along = (measured.exit_mm - measured.entry_on_surface_mm).normalized();
      return CaseReview(
          knee, {},
          {{kind,
            {bones::ImageCut{
                .at_mm = measured.exit_mm + beyond_exit_mm * along, .out = along, .area_mm2 = 500}}}});
    };
    const CaseReview cut = cut_off(-0.5), beside = cut_off(0.5);
    for (const bones::BoneKind asked : {kFemur, kTibia}) {
      const auto before = whole.checks(asked), now = cut.checks(asked), same = beside.checks(asked);
      ASSERT_EQ(before.size(), now.size());
      for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_EQ(same[i].text, before[i].text);
        if (before[i].name == "Graft length") {
          EXPECT_NE(before[i].text, now[i].text);
          EXPECT_NE(now[i].text.find(" in the joint, at least "), std::string::npos) << now[i].text;
        } else if (asked == bone && std::ranges::count(names, before[i].name) > 0) {
          EXPECT_NE(before[i].verdict, Verdict::NotChecked) << before[i].name;
          EXPECT_EQ(now[i].verdict, Verdict::NotChecked) << now[i].name;
          EXPECT_EQ(now[i].text, "not checked: the tunnel leaves where the images end");
        } else {
          EXPECT_EQ(now[i].text, before[i].text) << before[i].name;
        }
      }
    }
  }
}

// Nor is one that leaves through a hole that was filled in; and of a case of before that was recorded it is
// said that nobody knows, and how to mend it.
TEST(TunnelVerdict, Hazard46ATunnelThatLeavesThroughAFilledHoleIsNotChecked) {
  const tunnels::TunnelGeometry measured{.enters_bone = true, .exit_mm = {30, 0, 0}, .length_mm = 35};
  const auto text_of = [&](const bones::UnseenParts& unseen, const char* name) -> std::string {
    tunnels::PlanSurroundings known;
    known.unseen = unseen;
    const auto checks = tunnels::check_plan(kOfFemur, measured, known);
    const auto found = std::ranges::find(checks, name, &tunnels::PlanCheck::name);
    if (found == checks.end()) return "";
    EXPECT_EQ(found->verdict, Verdict::NotChecked);
    return found->text;
  };
  const bones::UnseenParts hole{.filled_holes = {{.at_mm = {30, 4, 0}, .across_mm = 12}}};
  for (const char* name : {"Length", "Exit", "Posterior cortex"})
    EXPECT_EQ(text_of(hole, name),
              "not checked: the tunnel leaves through a hole about 12 mm across that was filled in when the "
              "bone was made");
  EXPECT_EQ(text_of(hole, "Seen bone"), "");
  EXPECT_NE(text_of({.was_looked_for = false}, "Seen bone").find("import it again"), std::string::npos);
}

// What is too long as far as the images go is so beyond them.
TEST(TunnelVerdict, ATunnelThatIsTooLongWithinTheImagesIsTooLong) {
  tunnels::PlanSurroundings known;
  const tunnels::TunnelGeometry measured{.enters_bone = true, .exit_mm = {60, 0, 0}, .length_mm = 60};
  known.unseen.image_cuts = {{.at_mm = {59, 0, 0}, .out = {1, 0, 0}, .area_mm2 = 500}};
  const auto checks = tunnels::check_plan(kOfFemur, measured, known);
  EXPECT_EQ(checks.front().name, "Length");
  EXPECT_EQ(checks.front().verdict, Verdict::Wrong) << checks.front().text;
}

// A tick that rests on the side is none while the side is in doubt; what is wrong stays wrong.
TEST(TunnelVerdict, WhileTheSideIsInDoubtNothingThatRestsOnItIsFine) {
  const std::vector<tunnels::PlanCheck> checks = {
      {.verdict = Verdict::Fine, .name = "Entry", .text = "on the lateral wall of the notch"},
      {.verdict = Verdict::Wrong, .name = "Exit", .text = "into the notch"},
      {.verdict = Verdict::Fine, .name = "Wall", .text = "4.0 mm", .rests_on_side = false}};
  const auto doubted = as_side_is_doubted(checks, kOtherSide.words());
  EXPECT_EQ(doubted[0].verdict, Verdict::NotChecked);
  EXPECT_EQ(doubted[0].text, "not checked: the side is in doubt");
  EXPECT_EQ(doubted[1].verdict, Verdict::Wrong);
  EXPECT_EQ(doubted[2].verdict, Verdict::Fine) << "of no side";
  EXPECT_EQ(as_side_is_doubted(checks, "")[0].verdict, Verdict::Fine);
}

// What is said to rest on no side is the same whichever the knee is said to be; and there is such.
TEST(TunnelVerdict, WhatRestsOnNoSideIsTheSameOfEither) {
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "Knee");
  const CaseReview right(knee);
  knee.side = bones::Side::Left;
  const CaseReview left(knee);
  for (const bones::BoneKind bone : {kFemur, kTibia}) {
    const auto of_right = right.checks(bone), of_left = left.checks(bone);
    std::size_t count = 0;
    for (const tunnels::PlanCheck& check : of_right) {
      if (check.rests_on_side) continue;
      ++count;
      const auto same = std::ranges::find(of_left, check.name, &tunnels::PlanCheck::name);
      ASSERT_NE(same, of_left.end()) << check.name;
      EXPECT_EQ(same->text, check.text);
      EXPECT_EQ(same->verdict, check.verdict) << check.name;
    }
    EXPECT_EQ(count, 3U) << "length, wall and diameter";
  }
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
