#include "planning/default_plan/default_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <vector>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/plan_export/drilled_bone.h"
#include "planning/tunnels/plan_norms.h"
#include "tests/planning/default_plan/knee_inputs.h"

namespace arthronaut::default_plan {
namespace {

using bones::BoneKind;
using bones::Side;
using Eigen::Vector3d;
using test::Knee;
using test::knee_of;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

std::map<BoneKind, DefaultTunnel> plan_both(const Knee& knee, bool with_landmarks, Side side) {
  std::map<BoneKind, DefaultTunnel> plan;
  for (const BoneInput& input : knee.inputs(with_landmarks)) plan[input.bone->kind] = plan_bone(input, side);
  return plan;
}

// A drill comes to the femur from the front, below and medially and leaves on the lateral side; to the tibia
// it goes down, forwards and medially. In the phantom's frame: lateral is -x on the right, anterior -y,
// proximal z.
TEST(DefaultPlan, AimsAsADrillCanFollow) {
  for (const Side side : {Side::Left, Side::Right}) {
    const Knee& knee = knee_of(side);
    const double lateral = side == Side::Right ? -1 : 1;
    const auto plan = plan_both(knee, true, side);
    const auto& femur = plan.at(BoneKind::Femur);
    ASSERT_TRUE(femur.is_usable()) << femur.message;
    EXPECT_TRUE(femur.doubts.empty()) << femur.doubts[0];
    EXPECT_GT(lateral * femur.tunnel.direction.x(), 0.4);
    EXPECT_LT(femur.tunnel.direction.y(), -0.2);
    EXPECT_GT(femur.tunnel.direction.z(), 0.2);
    const auto of_femur = tunnels::measure(femur.tunnel, knee.femur);
    EXPECT_GT(of_femur.length_mm, 29);
    EXPECT_GT(of_femur.wall_mm, 1);
    const auto& tibia = plan.at(BoneKind::Tibia);
    ASSERT_TRUE(tibia.is_usable()) << tibia.message;
    EXPECT_LT(lateral * tibia.tunnel.direction.x(), -0.1);
    EXPECT_LT(tibia.tunnel.direction.y(), -0.2);
    EXPECT_LT(tibia.tunnel.direction.z(), -0.6);
    EXPECT_GT(tunnels::measure(tibia.tunnel, knee.tibia).length_mm, 30);
    // Where the ligament was: 28/35 % there, the norm's 28.4/35.7 % here, of a grid of 52 by 30 mm; a
    // millimetre is how far apart the wall is met from two places in the notch.
    EXPECT_LT((femur.tunnel.entry_mm - knee.made.femur_landmarks.at("native_footprint")).norm(), 1.5);
    EXPECT_LT((tibia.tunnel.entry_mm - knee.made.tibia_landmarks.at("native_footprint")).norm(), 3);
  }
}

// What the program proposes is not what it warns of: each check of a tunnel alone is passed on the built-in
// knee, with landmarks that are placed and with proposed ones.
TEST(DefaultPlan, PassesTheChecksOfItsOwnPlan) {
  for (const Side side : {Side::Left, Side::Right}) {
    for (const bool with_landmarks : {true, false}) {
      for (const auto& [kind, made] : plan_both(knee_of(side), with_landmarks, side)) {
        ASSERT_TRUE(made.is_usable()) << made.message;
        for (const auto& check : made.failed)
          ADD_FAILURE() << bones::to_text(side) << " " << check.name << ": " << check.text;
      }
    }
  }
}

// A hole beside the tibia's tunnel leaves too thin a wall to any aim from the norm's place, as a steep flank
// of the eminence does: the entry stays where the norm has it, and it is said which place within the norm's
// spread passes every check, or that none does.
TEST(DefaultPlan, SaysWhereWithinTheNormsSpreadATibiaPassesEveryCheck) {
  const Knee& knee = knee_of(Side::Right);
  const auto whole = plan_bone(knee.inputs(true)[1], Side::Right);
  ASSERT_TRUE(whole.failed.empty());
  EXPECT_FALSE(whole.other_entry);
  EXPECT_EQ(whole.place, "at the norm's place");
  constexpr double kHole_mm = 6;
  for (const double wall_left_mm : {0.2, -1.2, -2.0}) {
    SCOPED_TRACE(wall_left_mm);
    tunnels::Tunnel hole = whole.tunnel;
    hole.diameter_mm = kHole_mm;
    const Vector3d across = Vector3d::UnitX() - hole.direction.x() * hole.direction;  // medial
    hole.entry_mm += (whole.tunnel.diameter_mm / 2 + kHole_mm / 2 + wall_left_mm) * across.normalized();
    const auto mouth = knee.tibia.first_hit(hole.entry_mm - 30 * hole.direction, hole.direction);
    ASSERT_TRUE(mouth);
    hole.entry_mm = mouth->point_mm;
    const auto drilled = plan_export::drill(knee.made.tibia.mesh, hole);
    ASSERT_TRUE(drilled.is_usable()) << drilled.reason;
    const bones::Bone tibia{BoneKind::Tibia, drilled.mesh, ""};
    const geometry::Surface surface(tibia.mesh);
    BoneInput input = knee.inputs(true)[1];
    input.bone = &tibia;
    input.surface = &surface;
    const auto made = plan_bone(input, Side::Right);
    ASSERT_TRUE(made.is_usable()) << made.message;
    EXPECT_LT((made.tunnel.entry_mm - whole.tunnel.entry_mm).norm(), 1e-6);
    EXPECT_FALSE(made.failed.empty());
    // The thin place lies towards the hole, at the tunnel's side or where that is cut away.
    const auto wall = std::ranges::find(made.failed, "Wall", &tunnels::PlanCheck::name);
    ASSERT_NE(wall, made.failed.end());
    const double medial_mm = wall->at_mm->x() - made.tunnel.entry_mm.x();
    EXPECT_NEAR(medial_mm, whole.tunnel.diameter_mm / 2 + std::min(wall_left_mm, 0.0), 1);
    EXPECT_THAT(made.place, StartsWith("at the norm's place; there the bone beside it is thinnest "));
    EXPECT_THAT(made.place, HasSubstr(files::format("%.1f mm medial", medial_mm)));
    const bool is_wrong = wall->verdict == tunnels::PlanCheck::Verdict::Wrong;
    EXPECT_EQ(is_wrong, wall_left_mm < 0);
    // No place passes, but one where the tunnel does not break out is better than the norm's.
    if (wall_left_mm == -1.2) {
      ASSERT_TRUE(made.other_entry) << made.place;
      EXPECT_FALSE(made.other_entry->passes());
      EXPECT_THAT(made.place,
                  HasSubstr("still within the norm's spread, can be drilled; none there passes every "
                            "check, and to be looked at is Wall: 0."));
      const auto moved = moved_within_spread(made);
      const double left_mm = tunnels::measure(moved.tunnel, surface).wall_mm;
      EXPECT_GT(left_mm, 0);
      EXPECT_LT(left_mm, 1);
      ASSERT_EQ(moved.failed.size(), 1U);
      EXPECT_EQ(moved.failed[0].verdict, tunnels::PlanCheck::Verdict::Look);
      EXPECT_THAT(moved.place,
                  HasSubstr("within its spread, where it can be drilled; at the norm's place Wall: "));
      continue;
    }
    if (wall_left_mm < 0) {
      EXPECT_THAT(made.place,
                  EndsWith(" of the entry; with this aim no place within the norm's spread is better"));
      EXPECT_FALSE(made.other_entry);
      continue;
    }
    ASSERT_TRUE(made.other_entry) << made.place;
    const double away_mm = (made.other_entry->entry_mm - made.tunnel.entry_mm).norm();
    EXPECT_GT(away_mm, 0.3);
    EXPECT_LT(away_mm, 2);  // one sigma is 1.8 mm
    EXPECT_THAT(made.place, HasSubstr(files::format(
                                " of the entry; with this aim a tunnel %.1f mm from that entry (", away_mm)));
    EXPECT_NE(made.place.find(" mm lateral, "), std::string::npos) << made.place;  // the hole is medial
    tunnels::Tunnel moved = made.tunnel;
    moved.entry_mm = made.other_entry->entry_mm;
    EXPECT_GE(tunnels::measure(moved, surface).wall_mm, 1);  // what the tibia's check asks for
    const auto taken = moved_within_spread(made);
    EXPECT_EQ(taken.tunnel.entry_mm, made.other_entry->entry_mm);
    EXPECT_EQ(taken.tunnel.direction, made.tunnel.direction);
    EXPECT_NEAR(taken.off_norm_mm, away_mm, 1e-9);
    EXPECT_TRUE(taken.failed.empty());
    EXPECT_THAT(taken.place,
                StartsWith(files::format("%.1f mm off the norm's place, within its spread, where "
                                         "it passes; at the norm's place Wall: ",
                                         away_mm)));
    const auto narrow = plan_bone(input, Side::Right, {.diameter_mm = 7.8});
    ASSERT_TRUE(narrow.other_entry) << narrow.place;
    EXPECT_THAT(narrow.place, EndsWith("passes every check but that of its diameter, which was asked for"));
    EXPECT_THAT(made.place, EndsWith("passes every check"));
  }
}

// A grid that reaches further back puts the norm's place nearer to the back wall, until no aim leaves what
// the check asks for: it stays where the norm has it, and the check that fails is named.
TEST(DefaultPlan, NamesTheCheckThatNoAimPasses) {
  const Knee& knee = knee_of(Side::Right);
  BoneInput femur = knee.inputs(true)[0];
  const auto proposed =
      landmarks::propose(knee.made.femur.mesh, BoneKind::Femur, {.side = Side::Right}).landmarks;
  for (const char* extent : {"lateral_condyle_deep", "lateral_condyle_shallow", "lateral_condyle_low"})
    femur.landmarks[extent] = proposed.at(extent);
  for (const double further_mm : {8.0, 16.0}) {
    SCOPED_TRACE(further_mm);
    femur.landmarks["lateral_condyle_deep"] =
        proposed.at("lateral_condyle_deep") + further_mm * Vector3d::UnitY();
    const auto made = plan_bone(femur, Side::Right, {.diameter_mm = 9});
    ASSERT_TRUE(made.is_usable()) << made.message;
    EXPECT_EQ(made.off_norm_mm, 0);
    const bool is_thin =
        tunnels::measure(made.tunnel, knee.femur).wall_mm < tunnels::PlanNorms{}.thin_wall_mm;
    EXPECT_EQ(is_thin, further_mm > 10);
    ASSERT_EQ(made.failed.size(), is_thin ? 1U : 0U);
    EXPECT_EQ(moved_within_spread(made).tunnel.entry_mm,
              (made.other_entry ? made.other_entry->entry_mm : made.tunnel.entry_mm));
    if (!is_thin) {
      EXPECT_FALSE(made.other_entry);
      continue;
    }
    EXPECT_EQ(made.failed[0].name, "Wall");
    ASSERT_TRUE(made.other_entry) << made.place;
    EXPECT_THAT(made.place, HasSubstr(" anterior), still within the norm's spread, passes every check"));
    EXPECT_GE(tunnels::measure(moved_within_spread(made).tunnel, knee.femur).wall_mm,
              tunnels::PlanNorms{}.thin_wall_mm);
  }
}

// Without landmarks they are proposed, and that is a doubt which names them.
TEST(DefaultPlan, SaysThatNobodyHasConfirmedItsLandmarks) {
  const Knee& knee = knee_of(Side::Right);
  for (const auto& [kind, tunnel] : plan_both(knee, false, Side::Right)) {
    ASSERT_TRUE(tunnel.is_usable()) << tunnel.message;
    ASSERT_FALSE(tunnel.doubts.empty());
    EXPECT_NE(tunnel.doubts[0].find(kind == BoneKind::Femur ? "blumensaat_anterior" : "plateau_medial"),
              std::string::npos);
  }
}

// What is not there has been proposed by nobody: a grid that is seen along the scanner's axis, since the pair
// of condyles that tells its view is missing, is not called one that waits to be confirmed.
TEST(DefaultPlan, CallsMissingLandmarksMissing) {
  const Knee& knee = knee_of(Side::Right);
  BoneInput femur = knee.inputs(true)[0];
  femur.states.clear();  // as placed by hand
  std::erase_if(femur.landmarks, [](const auto& one) {
    return one.first.ends_with("_condyle_center") || one.first.ends_with("_condyle_posterior");
  });
  const auto made = plan_bone(femur, Side::Right);
  ASSERT_TRUE(made.is_usable()) << made.message;
  ASSERT_FALSE(made.doubts.empty());
  EXPECT_EQ(made.doubts[0],
            "the femur's landmarks that its grid needs are not all there: lateral_condyle_posterior, "
            "medial_condyle_posterior");
}

// Landmarks that were proposed otherwise, as by an older version that proposed fewer, are planned by as they
// are: they are what is shown and checked by. Where they give no grid all of them give way.
TEST(DefaultPlan, IsNeverOfTwoProposals) {
  const Knee& knee = knee_of(Side::Right);
  landmarks::Proposal own = landmarks::propose(knee.made.femur.mesh, BoneKind::Femur, {.side = Side::Right});
  ASSERT_TRUE(own.is_usable());
  landmarks::Proposal other = own;
  for (auto& [name, at_mm] : other.landmarks) at_mm += Vector3d(2, 0, 0);
  other.landmarks.at("lateral_condyle_center") += Vector3d(0, 8, 0);
  for (const char* name : {"lateral_condyle_center", "medial_condyle_center"}) own.landmarks.erase(name);
  BoneInput input{.bone = &knee.made.femur, .surface = &knee.femur, .landmarks = {}, .states = {}};
  landmarks::take_proposal(own, input.landmarks, input.states);
  const auto expect_same = [](const DefaultTunnel& made, const DefaultTunnel& expected) {
    ASSERT_TRUE(made.is_usable() && expected.is_usable());
    EXPECT_LT((made.tunnel.entry_mm - expected.tunnel.entry_mm).norm(), 1e-9);
    EXPECT_LT((made.tunnel.direction - expected.tunnel.direction).norm(), 1e-9);
  };
  BoneInput beside_other = input;
  input.proposal = &own;
  beside_other.proposal = &other;
  expect_same(plan_bone(beside_other, Side::Right), plan_bone(input, Side::Right));

  BoneInput without_grid = beside_other, none = beside_other;
  without_grid.landmarks.erase("blumensaat_posterior");
  none.landmarks.clear();
  expect_same(plan_bone(without_grid, Side::Right), plan_bone(none, Side::Right));
}

// The extents of the quadrant, where they are known, are what depth and height of the entry follow from.
TEST(DefaultPlan, DoubtsProposedExtentsOfTheQuadrant) {
  const Knee& knee = knee_of(Side::Right);
  BoneInput femur = knee.inputs(true)[0];
  femur.states.clear();
  for (const char* extent : {"lateral_condyle_deep", "lateral_condyle_shallow", "lateral_condyle_low"})
    femur.landmarks.try_emplace(
        extent, landmarks::propose(knee.made.femur.mesh, BoneKind::Femur, {.side = Side::Right})
                    .landmarks.at(extent));
  ASSERT_TRUE(plan_bone(femur, Side::Right).doubts.empty());
  femur.states["lateral_condyle_low"] = landmarks::LandmarkState::Proposed;
  const auto doubted = plan_bone(femur, Side::Right);
  ASSERT_FALSE(doubted.doubts.empty());
  EXPECT_TRUE(doubted.doubts[0].ends_with(": lateral_condyle_low")) << doubted.doubts[0];
  EXPECT_EQ(doubted.doubts[0].find("lateral_condyle_deep"), std::string::npos) << "that one is confirmed";
}

// A native footprint that a person marked is better than any norm, for the whole ligament.
TEST(DefaultPlan, EntersAtTheMarkedNativeFootprint) {
  const Knee& knee = knee_of(Side::Right);
  auto inputs = knee.inputs(true);
  inputs[0].landmarks = knee.made.femur_landmarks;
  const auto single = plan_bone(inputs[0], Side::Right);
  ASSERT_TRUE(single.is_usable());
  EXPECT_LT((single.tunnel.entry_mm - knee.made.femur_landmarks.at("native_footprint")).norm(), 1e-6);
  EXPECT_EQ(single.place, "at the native footprint");
  const auto am =
      plan_bone(inputs[0], Side::Right, {.bundle = norms::Bundle::Anteromedial, .diameter_mm = 6});
  const auto pl =
      plan_bone(inputs[0], Side::Right, {.bundle = norms::Bundle::Posterolateral, .diameter_mm = 6});
  ASSERT_TRUE(am.is_usable() && pl.is_usable());
  EXPECT_GT((am.tunnel.entry_mm - pl.tunnel.entry_mm).norm(), 5);
}

TEST(DefaultPlan, IsBesideTheOtherBundleOfItsBoneAlone) {
  using norms::Bundle;
  std::map<tunnels::TunnelKey, tunnels::Tunnel> planned;
  planned[{BoneKind::Femur, Bundle::Anteromedial}] = {};
  planned[{BoneKind::Tibia, Bundle::Whole}] = {};
  EXPECT_EQ(beside({BoneKind::Femur, Bundle::Posterolateral}, planned),
            &planned.at({BoneKind::Femur, Bundle::Anteromedial}));
  EXPECT_EQ(beside({BoneKind::Femur, Bundle::Anteromedial}, planned), nullptr);
  EXPECT_EQ(beside({BoneKind::Femur, Bundle::Whole}, planned), nullptr);
  EXPECT_EQ(beside({BoneKind::Tibia, Bundle::Anteromedial}, planned), nullptr);
}

// Whoever waits no longer is not kept waiting: no direction is tried any more, and it is not said that none
// is there.
TEST(DefaultPlan, StopsWhenItIsAskedTo) {
  const Knee& knee = knee_of(Side::Right);
  std::stop_source stop;
  for (const auto bundle : {norms::Bundle::Whole, norms::Bundle::Posterolateral}) {
    const Options options{.bundle = bundle, .stop = stop.get_token()};
    EXPECT_TRUE(plan_bone(knee.inputs(true)[0], Side::Right, options).is_usable());
  }
  stop.request_stop();
  for (const auto bundle : {norms::Bundle::Whole, norms::Bundle::Posterolateral}) {
    const Options options{.bundle = bundle, .stop = stop.get_token()};
    EXPECT_EQ(plan_bone(knee.inputs(true)[0], Side::Right, options).outcome, DefaultTunnel::Outcome::Stopped);
    EXPECT_EQ(plan_bone(knee.inputs(false)[0], Side::Right, options).outcome, DefaultTunnel::Outcome::Stopped)
        << "nor are landmarks looked for";
  }
}

TEST(DefaultPlan, RefusesOptionsOutOfRange) {
  const Knee& knee = knee_of(Side::Right);
  EXPECT_THROW((void)plan_bone(knee.inputs(true)[0], Side::Right, {.diameter_mm = 20}), InvalidInput);
  EXPECT_THROW((void)plan_bone(knee.inputs(true)[0], Side::Right, {.flexion_deg = 60}), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::default_plan
