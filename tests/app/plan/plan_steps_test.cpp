#include "app/plan/plan_steps.h"

#include <gtest/gtest.h>

#include "planning/phantom/phantom_case.h"

namespace arthronaut::plan {
namespace {

using bones::BoneKind;

cases::Case knee() { return phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test"); }

// From an empty case to theatre, one step after the other, each with the action that begins it.
TEST(NextStep, LeadsFromAnEmptyCaseToTheatre) {
  const cases::Case planned = knee();
  cases::Case empty = planned;
  empty.plan = {};
  open_case::PlanModel model(empty);
  StepState state;
  EXPECT_EQ(next_step(model, state).action, "plan.default");
  state.places_entry = true;
  EXPECT_EQ(next_step(model, state).text, "Click on the femur where the tunnel begins");
  state.places_entry = false;
  model.set_tunnel(BoneKind::Femur, planned.plan.tunnels.at(BoneKind::Femur));
  EXPECT_EQ(next_step(model, state).action, "plan.bone");
  state.key = BoneKind::Tibia;
  EXPECT_EQ(next_step(model, state).action, "plan.default");
  model.set_tunnel(BoneKind::Tibia, planned.plan.tunnels.at(BoneKind::Tibia));
  EXPECT_EQ(next_step(model, state).action, "mode.setup") << next_step(model, state).text;
}

// A tunnel that cannot be drilled is to be mended before anything else, from either bone.
TEST(NextStep, ATunnelThatCannotBeDrilledComesFirst) {
  open_case::PlanModel model(knee());
  tunnels::Tunnel beside = *model.tunnel(BoneKind::Femur);
  beside.entry_mm += Eigen::Vector3d(0, -300, 0);
  model.set_tunnel(BoneKind::Femur, beside);
  EXPECT_NE(next_step(model, {}).text.find("Mend the femoral tunnel"), std::string::npos);
  EXPECT_EQ(next_step(model, {.key = BoneKind::Tibia}).text, "Mend the femoral tunnel: press Tab");
}

// Where the default knows of a better place, that is the way out; but the points that everything is put by
// are looked at before.
TEST(NextStep, WhatIsWrongIsMendedWhereTheNormsSpreadAllowsIt) {
  open_case::PlanModel model(knee());
  tunnels::Tunnel beside = *model.tunnel(BoneKind::Femur);
  beside.entry_mm += Eigen::Vector3d(0, -300, 0);
  model.set_tunnel(BoneKind::Femur, beside);
  EXPECT_EQ(next_step(model, {}).action, "");
  const NextStep next = next_step(model, {.can_enter_elsewhere = true});
  EXPECT_EQ(next.action, "plan.within_spread");
  EXPECT_TRUE(next.text.ends_with(". Shift+N enters beside it, where nothing is wrong; or drag it"))
      << next.text;
  landmarks::LandmarkStates states = model.landmark_states(BoneKind::Femur);
  states["blumensaat_anterior"] = landmarks::LandmarkState::Proposed;
  model.set_landmarks(BoneKind::Femur, model.landmarks(BoneKind::Femur), states);
  EXPECT_EQ(next_step(model, {.can_enter_elsewhere = true}).action, "plan.landmarks_page");
}

// Both bones' landmarks, before the plan is said to be ready.
TEST(NextStep, TheOtherBonesLandmarksAreLookedAtToo) {
  open_case::PlanModel model(knee());
  landmarks::LandmarkStates states = model.landmark_states(BoneKind::Tibia);
  for (const auto& [name, at] : model.landmarks(BoneKind::Tibia))
    states[name] = landmarks::LandmarkState::Proposed;
  model.set_landmarks(BoneKind::Tibia, model.landmarks(BoneKind::Tibia), states);
  const NextStep next = next_step(model, {});
  EXPECT_EQ(next.action, "plan.bone");
  EXPECT_EQ(next.text, "Look at the tibia's landmarks, which nobody has confirmed: press Tab, then L");
  EXPECT_TRUE(next_step(model, {.shows_landmarks = true}).text.ends_with("press Tab"));
}

// A grid that follows from points that nobody has looked at is not the end; one of confirmed points is.
TEST(NextStep, ProposedLandmarksAreToBeLookedAt) {
  open_case::PlanModel model(knee());
  landmarks::LandmarkStates states = model.landmark_states(BoneKind::Femur);
  states["blumensaat_anterior"] = landmarks::LandmarkState::Proposed;
  model.set_landmarks(BoneKind::Femur, model.landmarks(BoneKind::Femur), states);
  EXPECT_EQ(next_step(model, {}).action, "plan.landmarks_page");
  states["blumensaat_anterior"] = landmarks::LandmarkState::Confirmed;
  model.set_landmarks(BoneKind::Femur, model.landmarks(BoneKind::Femur), states);
  EXPECT_EQ(next_step(model, {}).action, "mode.setup");
  // The direction of the view of the grid is told by the condyles.
  landmarks::Landmarks marks = model.landmarks(BoneKind::Femur);
  ASSERT_TRUE(marks.contains("lateral_condyle_center") || marks.contains("lateral_condyle_posterior"));
  for (const char* part : {"lateral_condyle_center", "lateral_condyle_posterior"})
    states[part] = landmarks::LandmarkState::Proposed;
  model.set_landmarks(BoneKind::Femur, marks, states);
  EXPECT_EQ(next_step(model, {}).action, "plan.landmarks_page");
}

// A key that has been pressed is not asked for again.
TEST(NextStep, ADefaultPlanOnItsWayIsWaitedFor) {
  const open_case::PlanModel model(knee());
  const NextStep next = next_step(model, {.makes_default = true});
  EXPECT_EQ(next.text.find("Wait for the default plan"), 0U);
  EXPECT_EQ(next.action, "");
}

// Where the landmarks are looked at already, the key that opened them is not asked for again.
TEST(NextStep, OnTheLandmarksPageTheyAreConfirmed) {
  cases::Case proposed = knee();
  for (const auto& [kind, marks] : proposed.landmarks)
    for (const auto& [name, position] : marks)
      proposed.landmark_states[kind][name] = landmarks::LandmarkState::Proposed;
  const open_case::PlanModel model(proposed);
  EXPECT_EQ(next_step(model, {}).action, "plan.landmarks_page");
  const NextStep there = next_step(model, {.shows_landmarks = true});
  EXPECT_EQ(there.action, "plan.landmark_confirm");
  EXPECT_EQ(there.text, "Look at each landmark of the femur: Enter confirms it, or drag it");
}

// What stands against every edit is named first.
TEST(NextStep, ReadOnlyAndConflictAreNamedFirst) {
  const open_case::PlanModel model(knee());
  // Another program has it open, or its folder cannot be written: which, the plan's own line says.
  EXPECT_EQ(next_step(model, {.is_read_only = true}).text,
            "Look only: why the plan cannot be changed is said below");
  EXPECT_EQ(next_step(model, {.is_in_conflict = true}).action, "plan.take_theirs");
  EXPECT_TRUE(next_step(model, {.is_unsaved = true}).text.starts_with("The plan is not saved"))
      << "not to theatre";
}

// One bundle alone is half a plan; a pair that runs into each other is to be mended.
TEST(NextStep, OfTwoBundlesBothAreWanted) {
  open_case::PlanModel model(knee());
  const tunnels::TunnelKey am{BoneKind::Femur, norms::Bundle::Anteromedial},
      pl{BoneKind::Femur, norms::Bundle::Posterolateral};
  const tunnels::Tunnel single = *model.tunnel(BoneKind::Femur);
  model.set_tunnel(am, single);
  EXPECT_EQ(next_step(model, {.key = am}).text, "Plan the femoral PL tunnel too: press B");
  EXPECT_EQ(next_step(model, {.key = BoneKind::Tibia}).text, "Plan the femoral PL tunnel too: press Tab");
  EXPECT_EQ(next_step(model, {.key = pl}).action, "plan.place") << "the default would move the other";
  const NextStep on_landmarks = next_step(model, {.key = pl, .shows_landmarks = true});
  EXPECT_EQ(on_landmarks.action, "plan.checks_page") << "P is the landmarks' there";
  EXPECT_TRUE(on_landmarks.text.ends_with("press C, then P")) << on_landmarks.text;
  model.set_tunnel(pl, single);
  EXPECT_EQ(next_step(model, {.key = am}).text,
            "Mend the femoral AM tunnel: Between the tunnels. Drag its entry (M shows where to) or its aim, "
            "or take "
            "another diameter");
}

// A knee of the wrong side has every landmark on the wrong side: that comes before any tunnel.
TEST(NextStep, ADoubtedSideComesFirst) {
  const open_case::PlanModel model(knee());
  const NextStep next = next_step(model, {.side_doubt = "the fibula lies on the left of the tibia"});
  EXPECT_TRUE(
      next.text.starts_with("Check the side first: the fibula lies on the left of the tibia. Press "
                            "J and say which knee it is"))
      << next.text;
  EXPECT_EQ(next.action, "plan.side");
}

// A plan with open warnings can be taken to theatre, and says how many.
TEST(NextStep, ToTheatreWithItsWarnings) {
  open_case::PlanModel model(knee());
  const std::size_t before = warning_count(model);
  tunnels::Tunnel wide = *model.tunnel(BoneKind::Tibia);
  wide.diameter_mm = 6;
  model.set_tunnel(BoneKind::Tibia, wide);
  EXPECT_GT(warning_count(model), before);
  const NextStep next = next_step(model, {});
  EXPECT_EQ(next.action, "mode.setup");
  EXPECT_TRUE(next.text.starts_with("The plan can be taken to theatre, with ")) << next.text;
  EXPECT_NE(next_step(model, {.bone_doubts = 1}).text.find(" warnings: set up the arthroscope"),
            std::string::npos);
}

// A shape that proposes nothing, and two landmarks that do not suffice: what is missing is named, and the key
// that places it, instead of the default that would be refused.
TEST(NextStep, NamesTheLandmarksThatADefaultLacks) {
  cases::Case half = knee();
  half.plan = {};
  geometry::TriangleMesh& mesh = half.bones.at(BoneKind::Femur).mesh;
  mesh.triangles.resize(mesh.triangles.size() / 4);  // a piece: no shape to propose by
  std::erase_if(half.landmarks.at(BoneKind::Femur),
                [](const auto& one) { return !one.first.starts_with("blumensaat"); });
  const open_case::PlanModel model(half);
  ASSERT_FALSE(missing_for_default(model, BoneKind::Femur).empty());
  const NextStep next = next_step(model, {});
  EXPECT_TRUE(next.text.starts_with("For a default plan ")) << next.text;
  const std::string title(landmarks::find_landmark(BoneKind::Femur, "lateral_condyle_posterior")->title);
  EXPECT_NE(next.text.find('"' + title + '"'), std::string::npos) << "a title holds commas: " << next.text;
  EXPECT_EQ(next.action, "plan.landmarks_page");
  EXPECT_EQ(next_step(model, {.shows_landmarks = true}).action, "plan.landmark_place");
}

TEST(WorstFirst, KeepsTheOrderOfTheRest) {
  using Verdict = tunnels::PlanCheck::Verdict;
  const std::vector<tunnels::PlanCheck> checks{{.verdict = Verdict::Fine, .name = "a", .text = ""},
                                               {.verdict = Verdict::Look, .name = "b", .text = ""},
                                               {.verdict = Verdict::NotChecked, .name = "c", .text = ""},
                                               {.verdict = Verdict::Wrong, .name = "d", .text = ""},
                                               {.verdict = Verdict::Look, .name = "e", .text = ""}};
  std::string order;
  for (const tunnels::PlanCheck* const check : worst_first(checks)) order += check->name;
  EXPECT_EQ(order, "dbeac");
}

// Two bundles in one bone and a single tunnel in the other is more often forgotten than meant.
TEST(NextStep, OneTunnelBesideTwoOfTheOtherBoneIsAskedAbout) {
  open_case::PlanModel model(knee());
  const tunnels::TunnelKey am{BoneKind::Tibia, norms::Bundle::Anteromedial},
      pl{BoneKind::Tibia, norms::Bundle::Posterolateral};
  const auto made_am = model.default_tunnel(am), made_pl = model.default_tunnel(pl);
  ASSERT_TRUE(made_am.is_usable() && made_pl.is_usable());
  model.set_tunnel(am, made_am.tunnel);
  model.set_tunnel(pl, made_pl.tunnel);
  const NextStep here = next_step(model, {.key = BoneKind::Femur}), there = next_step(model, {.key = am});
  EXPECT_EQ(here.action, "plan.bundles");
  EXPECT_TRUE(here.text.starts_with("The femur has one tunnel and the tibia two")) << here.text;
  EXPECT_EQ(there.action, "plan.bone");
  EXPECT_TRUE(there.text.starts_with("The femur has one tunnel and the tibia two")) << there.text;
}

}  // namespace
}  // namespace arthronaut::plan
