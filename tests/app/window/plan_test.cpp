// Plan mode from outside, as a hand works it.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/cases/measurements.h"
#include "planning/painting/bone_labels.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/app/window/plan_window.h"

namespace arthronaut::test {
namespace {

// As the window's log of states writes lengths.
std::string fixed(double value) {
  char text[16];
  std::snprintf(text, sizeof(text), "%.2f", value);
  return text;
}

// From the front the femur hides its entry: a drag there turns the bone, and the plan stays. In the notch
// view the entry is seen, and three pixels move it by what three pixels are.
TEST_F(PlanWindow, OnlyAHandleThatIsSeenIsTakenHoldOf) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  const tunnels::Tunnel before = saved_tunnel();
  const auto [x, y] = middle(app, "plan.entry_handle");
  app.drag(x, y, x + 3, y);
  app.press("6");
  ASSERT_TRUE(app.wait_for_state("view_direction", "notch"));
  EXPECT_EQ(app.state("undo"), "");
  EXPECT_EQ(saved_tunnel().entry_mm, before.entry_mm);
  const auto [seen_x, seen_y] = middle(app, "plan.entry_handle");
  app.drag(seen_x, seen_y, seen_x + 3, seen_y);
  ASSERT_TRUE(app.wait_for_state("undo", "Drag the entry of the femoral tunnel"));
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  const double moved = (saved_tunnel().entry_mm - before.entry_mm).norm();
  EXPECT_GT(moved, 0.1);
  EXPECT_LT(moved, 2.5);  // 3 px of 0.25 mm on a wall that lies up to 70 degrees off the view
}

// The button of a view is lit while the bones are seen from there, not after they were turned.
TEST_F(PlanWindow, AViewThatWasTurnedIsNoMoreTheViewThatItWas) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  ASSERT_TRUE(app.wait_for_state("view_direction", "anterior"));
  const auto [x, y] = middle(app, "plan.view");
  app.drag(x + 200, y, x + 240, y);
  ASSERT_TRUE(app.wait_for_state("view_direction", "turned by hand"));
  app.press("1");
  EXPECT_TRUE(app.wait_for_state("view_direction", "anterior"));
}

// P: Esc leaves it; a click on the other bone, or beside both, says so and leaves no step to undo.
TEST_F(PlanWindow, PlacingCanBeLeftAndTakesNoOtherBone) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("placing", "entry"));
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("placing", "nothing"));
  app.press("p");
  const Area view = app.widgets().at("plan.view");
  app.click_at(view.x + view.width / 2, view.y + view.height * 3 / 4);  // the tibia's shaft
  EXPECT_TRUE(app.wait_for_state(
      "hint", "That is the tibia. Click on the femur, or press Tab to plan the other bone."));
  app.click_at(view.x + view.width / 20, view.y + view.height / 2);
  EXPECT_TRUE(app.wait_for_state("hint", "That is beside the bone. Click on the femur, or press Esc."));
  EXPECT_EQ(app.state("undo"), "");
  EXPECT_EQ(app.state("placing"), "entry");
  app.click_at(view.x + view.width / 2, view.y + view.height / 4);  // the femur's shaft
  EXPECT_TRUE(app.wait_for_state("undo", "Place the entry of the femoral tunnel"));
  EXPECT_EQ(app.state("placing"), "nothing");
}

// "+" is understood from every key that has it.
// The list of keys covers the whole screen: what is pressed or clicked under it does nothing but close it.
TEST_F(PlanWindow, NothingActsUnseenBehindTheListOfKeys) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  const std::string before = app.state("undo");
  for (const char* key : {"plus", "Delete", "n"}) {
    app.press("F10");
    ASSERT_TRUE(app.wait_for_state("key_list", "shown"));
    app.press(key);
    EXPECT_TRUE(app.wait_for_state("key_list", "none")) << key;
  }
  app.press("F10");
  ASSERT_TRUE(app.wait_for_state("key_list", "shown"));
  const auto [x, y] = middle(app, "plan.wider");
  app.click_at(x, y);
  EXPECT_TRUE(app.wait_for_state("key_list", "none"));
  app.press("F10");
  app.press("F10");
  EXPECT_TRUE(app.wait_for_state("key_list", "none"));
  EXPECT_EQ(app.state("undo"), before);
}

TEST_F(PlanWindow, PlusAndTheNumberPadWiden) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  const double before = saved_tunnel().diameter_mm;
  int presses = 0;
  for (const char* key : {"plus", "equal", "KP_Add"}) {
    app.press(key);
    ASSERT_TRUE(app.wait_for_state("diameter_mm", fixed(before + 0.5 * ++presses))) << key;
  }
  app.press("KP_Subtract");
  EXPECT_TRUE(app.wait_for_state("diameter_mm", fixed(before + 1.0)));
}

// Hazard 15: a plan that another program saves is noticed, told, and never written over unasked.
TEST_F(PlanWindow, Hazard15APlanOfAnotherProgramIsToldAndTheSurgeonChooses) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  cases::Plan elsewhere = cases::load_case(case_folder()).plan;
  elsewhere.tunnels.at(bones::BoneKind::Femur).diameter_mm = 7.25;
  cases::save_plan(case_folder(), elsewhere);
  ASSERT_TRUE(app.wait_for_state("plan", "conflict"));
  app.press("equal");
  ASSERT_TRUE(app.wait_for_state("undo", "Change the diameter of the femoral tunnel"));
  EXPECT_EQ(saved_tunnel().diameter_mm, 7.25);
  ASSERT_TRUE(app.wait_for_widget("plan.take_theirs"));
  EXPECT_NE(app.state("theirs").find("femur: "), std::string::npos) << app.state("theirs");
  app.press("F7");
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  EXPECT_TRUE(app.wait_for_state("diameter_mm", "7.25"));
}

// Slices of a case's images: shown beside the bones, scrolled by the wheel by one slice, windowed by a key; a
// distance that is clicked is on disk, is what its two points are apart, and can be undone.
TEST_F(PlanWindow, SlicesAreScrolledWindowedAndMeasuredIn) {
  const auto folder = folder_ / "Imaged.arthro";
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "imaged");
  images::Volume volume;
  volume.size = {60, 60, 60};
  volume.modality_in_file = "CT";
  volume.lps_from_index.linear() *= 2.5;
  volume.lps_from_index.translation() = Eigen::Vector3d(-75, -75, -75);
  for (int i = 0; i < 60 * 60 * 60; ++i) volume.values.push_back(static_cast<float>(i % 60 * 20));
  cases::save_case(folder, knee);
  knee.images.push_back({.file = "",
                         .modality = volume.modality_in_file,
                         .source = "NRRD",
                         .size = volume.size,
                         .spacing_mm = volume.spacing_mm()});
  cases::store_image(folder, 1, images::encoded(volume), knee.images.back());
  cases::save_case(folder, knee);
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {folder.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("s");
  ASSERT_TRUE(app.wait_for_state("slices", "shown"));
  ASSERT_TRUE(app.wait_for_widget("plan.axial_slice"));
  EXPECT_EQ(app.state("window"), "480 / 2500");
  app.press("w");
  EXPECT_TRUE(app.wait_for_state("window", "40 / 400"));
  const auto height = [&] {
    std::string cross = app.state("cross");
    cross = cross.substr(cross.rfind(' ') + 1);
    const std::string minus = "\u2212";
    return cross.starts_with(minus) ? -std::stod(cross.substr(minus.size())) : std::stod(cross);
  };
  const double before = height();
  app.scroll_up("plan.axial_slice");
  for (int i = 0; i < 500 && height() == before; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_NEAR(std::abs(height() - before), 2.5, 0.11);  // one slice; the state has a decimal
  app.press("d");
  const Area slice = app.widgets().at("plan.axial_slice");
  app.click_at(slice.x + slice.width / 4, slice.y + slice.height / 2);
  // Its length stands there before it ends.
  app.point_at("plan.axial_slice");
  std::string reached;
  for (int i = 0; i < 500 && (reached.empty() || reached.starts_with("0.0")); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    reached = app.state("measuring");
  }
  app.click_at(slice.x + slice.width / 2, slice.y + slice.height / 2);
  ASSERT_TRUE(app.wait_for_state("undo", "Measure a distance"));
  const auto measured = cases::load_measurements(folder);
  ASSERT_EQ(measured.size(), 1U);
  EXPECT_EQ(reached, measured[0].in_words());
  EXPECT_TRUE(app.wait_for_state("measuring", ""));
  EXPECT_TRUE(app.wait_for_state("measured", measured[0].in_words()));
  EXPECT_GT(measured[0].distance_mm(), 10);
  EXPECT_NEAR(measured[0].points_mm[0].z(), measured[0].points_mm[1].z(), 1e-9)
      << "both lie in the axial slice";
  app.press("ctrl+z");
  ASSERT_TRUE(app.wait_for_state("measured", ""));
  EXPECT_TRUE(cases::load_measurements(folder).empty());
  // The same by a drag.
  app.drag(slice.x + slice.width / 4, slice.y + slice.height / 2, slice.x + slice.width / 2,
           slice.y + slice.height / 2);
  ASSERT_TRUE(app.wait_for_state("undo", "Measure a distance"));
  const auto dragged = cases::load_measurements(folder);
  ASSERT_EQ(dragged.size(), 1U);
  EXPECT_NEAR(dragged[0].distance_mm(), measured[0].distance_mm(), 0.1);
}

// One key puts the images in the bones' place, another moves the threshold; the next presses show the soft
// tissue, and the bones again. Without images it says that there are none.
TEST_F(PlanWindow, ImagesTakeTheBonesPlaceByAKey) {
  const auto folder = folder_ / "Imaged.arthro";
  write_knee_with_ct(folder);
  const VirtualDisplay display(1280, 720);
  {
    RunningWorkstation app(display, folder_.path(), {folder.string()});
    ASSERT_TRUE(app.wait_for_state("case", "open", 120));
    ASSERT_TRUE(app.wait_for_widget("plan.view"));
    EXPECT_EQ(app.state("volume"), "");
    app.press("v");
    ASSERT_TRUE(app.wait_for_state("volume", "Images: bone above 250 HU (, less, . more)", 120));
    app.press("period");
    ASSERT_TRUE(app.wait_for_state("volume", "Images: bone above 275 HU (, less, . more)"));
    const auto [x, y] = middle(app, "plan.view");
    app.drag(x, y, x + 40, y);
    app.press("v");
    ASSERT_TRUE(app.wait_for_state("volume", "Images: bone and soft tissue above 275 HU (, less, . more)"));
    app.press("v");
    ASSERT_TRUE(app.wait_for_state("volume", ""));
    app.press("ctrl+q");
    EXPECT_EQ(app.wait_for_exit(30), 0);
  }
  RunningWorkstation without(display, folder_.path());
  open(without);
  without.press("v");
  EXPECT_TRUE(without.wait_for_state("untaken_key", "V did nothing: Images in 3D is not possible now"));
  without.press("s");  // the 3D view keeps its room
  EXPECT_TRUE(without.wait_for_state("untaken_key", "S did nothing: Slices is not possible now"));
  EXPECT_EQ(without.state("volume"), "");
}

// One key makes both tunnels, one undo takes them back; landmarks are gone through by keys, and confirming
// one is a step that is on disk.
TEST_F(PlanWindow, DefaultPlanAndLandmarksByKeys) {
  // A case that nobody has put a landmark in: all of them are proposed.
  cases::Case knee = cases::load_case(case_folder());
  knee.landmarks.clear();
  cases::save_case(case_folder(), knee);
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {case_folder().string()});
  open(app);
  const tunnels::Tunnel before = saved_tunnel();
  app.press("n");
  ASSERT_TRUE(app.wait_for_state("undo", "Make the default plan"));
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  EXPECT_NE(saved_tunnel().entry_mm, before.entry_mm);
  app.press("ctrl+z");
  ASSERT_TRUE(app.wait_for_state("redo", "Make the default plan"));
  EXPECT_EQ(saved_tunnel().entry_mm, before.entry_mm);
  app.press("l");
  ASSERT_TRUE(app.wait_for_state("landmark", "blumensaat_anterior"));
  app.press("Next");  // Page down
  ASSERT_TRUE(app.wait_for_state("landmark", "blumensaat_posterior"));
  app.press("shift+Return");
  ASSERT_TRUE(app.wait_for_state("undo", "Confirm all landmarks of the femur"));
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  const cases::Case saved = cases::load_case(case_folder());
  const auto states = saved.landmark_states.find(bones::BoneKind::Femur);
  ASSERT_FALSE(saved.landmarks.at(bones::BoneKind::Femur).empty());
  for (const auto& [name, position] : saved.landmarks.at(bones::BoneKind::Femur)) {
    if (states == saved.landmark_states.end()) break;  // what is not said to be proposed is confirmed
    EXPECT_EQ(landmarks::state_of(states->second, name), landmarks::LandmarkState::Confirmed) << name;
  }
}

// Where the keys end they say so; a key that does nothing would pass for one that was not heard.
TEST_F(PlanWindow, SaysWhereADiameterEnds) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  for (int i = 0; i < 12; ++i) app.press("equal");  // from 9 mm by halves
  ASSERT_TRUE(app.wait_for_state("diameter_mm", "15.00"));
  EXPECT_EQ(app.state("hint"), "");
  app.press("equal");
  EXPECT_TRUE(app.wait_for_state("hint", "A tunnel is planned 3 to 15 mm wide: this one is 15.0 mm."));
  app.press("minus");
  EXPECT_TRUE(app.wait_for_state("hint", ""));
}

// A version is kept, found again beside the one that was changed, and taken back as a step that undo ends.
TEST_F(PlanWindow, AVersionIsKeptAndTakenAgain) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  const double before_mm = saved_tunnel().diameter_mm;
  app.press("k");
  ASSERT_TRUE(app.wait_for_state("hint", "Kept as version 1. Shift+K gives it a name and a note"));
  app.press("equal");
  ASSERT_TRUE(app.wait_for_state("diameter_mm", fixed(before_mm + 0.5)));
  app.press("h");
  ASSERT_TRUE(app.wait_for_widget("plan.version.1"));
  app.click("plan.version.1");
  ASSERT_TRUE(app.wait_for_state("undo", "Take version 1"));
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  EXPECT_EQ(saved_tunnel().diameter_mm, before_mm);
  app.press("ctrl+z");
  EXPECT_TRUE(app.wait_for_state("diameter_mm", fixed(before_mm + 0.5)));
}

// Steps that were taken back stand in the list below the one that the plan is at, and a click does them
// again; the list is scrolled by the wheel.
TEST_F(PlanWindow, AStepThatWasTakenBackIsDoneAgainByAClick) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  app.press("h");
  constexpr int kSteps = 14;  // more than there is room for
  for (int i = 0; i < kSteps; ++i) {
    app.press(i % 2 == 0 ? "equal" : "Up");
    ASSERT_TRUE(app.wait_for_state(
        "undo", i % 2 == 0 ? "Change the diameter of the femoral tunnel" : "Aim the femoral tunnel"));
  }
  ASSERT_TRUE(app.wait_for_widget("plan.step." + std::to_string(kSteps), 5));
  app.press("ctrl+z");
  ASSERT_TRUE(app.wait_for_state("redo", "Aim the femoral tunnel"));
  const std::string undone = "plan.step." + std::to_string(kSteps);
  ASSERT_TRUE(app.wait_for_widget(undone, 5)) << "in sight, though it was undone";
  app.click(undone);
  EXPECT_TRUE(app.wait_for_state("redo", ""));
}

// Hazard 46: what spoke against the femur is said on its page, not on the tibia's; and in the radiograph,
// where no entry can be placed, P goes back to the bones.
TEST_F(PlanWindow, Hazard46WhatSpokeAgainstTheBoneStandsByItsChecks) {
  cases::save_bone_doubts(case_folder(), {{bones::BoneKind::Femur, {"the images end within it"}}});
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  EXPECT_TRUE(app.wait_for_state("bone_doubts", "1"));
  app.press("Tab");
  EXPECT_TRUE(app.wait_for_state("bone_doubts", "0"));
  app.press("x");
  ASSERT_TRUE(app.wait_for_widget("plan.lateral_view"));
  app.press("p");
  EXPECT_TRUE(app.wait_for_widget("plan.view"));
}

// The map of entries is of the tunnel as it is: an edit takes it away until it is made anew.
TEST_F(PlanWindow, TheMapOfEntriesFollowsThePlan) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  ASSERT_EQ(app.state("view_direction"), "anterior");
  app.press("m");
  // From the front the condyles hide where the tunnel begins.
  ASSERT_TRUE(app.wait_for_state("view_direction", "notch"));
  ASSERT_TRUE(app.wait_for_state("survey", "shown"));
  app.press("equal");
  ASSERT_TRUE(app.wait_for_state("survey", "working"));
  ASSERT_TRUE(app.wait_for_state("survey", "shown"));
  app.press("m");
  EXPECT_TRUE(app.wait_for_state("survey", "none"));
}

// B: two tunnels by the norms in place of one, each worked on by its own, and undo brings the single one
// back.
TEST_F(PlanWindow, TwoBundlesByOneKeyAndEachMovesAlone) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  const tunnels::Tunnel before = saved_tunnel();
  EXPECT_EQ(app.state("tunnel"), "femur");
  app.press("b");
  ASSERT_TRUE(app.wait_for_state("tunnel", "femur AM"));
  ASSERT_TRUE(app.wait_for_state("undo", "Plan two bundles in the femur"));
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  const cases::Plan both = cases::load_case(case_folder()).plan;
  ASSERT_EQ(both.of(bones::BoneKind::Femur).size(), 2U);
  app.press("b");
  ASSERT_TRUE(app.wait_for_state("tunnel", "femur PL"));
  app.press("plus");
  ASSERT_TRUE(app.wait_for_state("undo", "Change the diameter of the femoral PL tunnel"));
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  const cases::Plan wider = cases::load_case(case_folder()).plan;
  const tunnels::TunnelKey am{bones::BoneKind::Femur, norms::Bundle::Anteromedial},
      pl{bones::BoneKind::Femur, norms::Bundle::Posterolateral};
  EXPECT_EQ(wider.tunnels.at(am).diameter_mm, both.tunnels.at(am).diameter_mm);
  EXPECT_EQ(wider.tunnels.at(pl).diameter_mm, both.tunnels.at(pl).diameter_mm + 0.5);
  app.press("ctrl+z");
  app.press("ctrl+z");
  ASSERT_TRUE(app.wait_for_state("tunnel", "femur"));
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  EXPECT_EQ(saved_tunnel().entry_mm, before.entry_mm);
}

}  // namespace
}  // namespace arthronaut::test
