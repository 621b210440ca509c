// Which knee the case is, said in Plan as a hand says it; steps that outlive the program, versions with a
// name, slices along the tunnel, and a case that another machine had.
#include <gtest/gtest.h>

#include <chrono>
#include <regex>
#include <sstream>
#include <thread>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/case_image.h"
#include "planning/cases/plan_versions.h"
#include "planning/geometry/surface.h"
#include "planning/tunnels/tunnel.h"
#include "tests/app/window/plan_window.h"

namespace arthronaut::test {
namespace {

using bones::Side;

// J asks, 8 and 9 answer: the case is opened anew as the other knee, without the plan of the first, which is
// back with it. What spoke for the other side leads there.
TEST_F(PlanWindow, Hazard52TheSideIsChangedAndBack) {
  cases::save_bone_doubts(
      case_folder(),
      {{bones::BoneKind::Femur, {cases::SideDoubt{cases::SideWitness::Fibula, Side::Left, Side::Right}}}});
  const tunnels::Tunnel planned = saved_tunnel();
  const VirtualDisplay display(1600, 900);
  RunningWorkstation app(display, folder_.path());
  open(app);
  EXPECT_TRUE(app.state("plan_next").starts_with("Check the side first")) << app.state("plan_next");
  app.press("8");
  EXPECT_EQ(app.state("asks_side"), "") << "an answer without a question";
  app.press("j");
  ASSERT_TRUE(app.wait_for_state("asks_side", "asks"));
  ASSERT_TRUE(app.wait_for_widget("plan.left_knee"));
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("asks_side", ""));
  app.press("j");
  ASSERT_TRUE(app.wait_for_state("asks_side", "asks"));
  app.press("8");
  ASSERT_TRUE(app.wait_for_state("case", "opening"));
  ASSERT_TRUE(app.wait_for_state("case", "open", 240));
  for (int i = 0; i < 200 && app.state("hint").empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_TRUE(app.state("hint").starts_with("It is a left knee now; it was a right one"))
      << app.state("hint");
  EXPECT_FALSE(app.state("plan_next").starts_with("Check the side"));
  const cases::Case left = cases::load_case(case_folder());
  EXPECT_EQ(left.side, Side::Left);
  EXPECT_TRUE(left.plan.tunnels.empty());
  app.press("j");
  ASSERT_TRUE(app.wait_for_state("asks_side", "asks"));
  app.press("9");
  ASSERT_TRUE(app.wait_for_state("case", "opening"));
  ASSERT_TRUE(app.wait_for_state("case", "open", 240));
  EXPECT_EQ(cases::load_case(case_folder()).side, Side::Right);
  EXPECT_EQ(saved_tunnel().entry_mm, planned.entry_mm);
  EXPECT_TRUE(app.wait_for_widget("plan.entry_handle"));
}

// Ctrl+Q and the next day: what was done is listed, and is taken back.
TEST_F(PlanWindow, StepsOutliveTheProgram) {
  const double start_mm = saved_tunnel().diameter_mm;
  const VirtualDisplay display(1600, 900);
  {
    RunningWorkstation app(display, folder_.path());
    open(app);
    app.press("minus");
    ASSERT_TRUE(app.wait_for_state("undo", "Change the diameter of the femoral tunnel"));
    ASSERT_TRUE(app.wait_for_state("plan", "saved"));
    app.press("ctrl+q");
    EXPECT_EQ(app.wait_for_exit(60), 0);
  }
  EXPECT_NE(saved_tunnel().diameter_mm, start_mm);
  RunningWorkstation app(display, folder_.path());
  open(app);
  EXPECT_EQ(app.state("undo"), "Change the diameter of the femoral tunnel");
  app.press("h");
  ASSERT_TRUE(app.wait_for_widget("plan.step.1"));
  app.press("ctrl+z");
  ASSERT_TRUE(app.wait_for_state("redo", "Change the diameter of the femoral tunnel"));
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  EXPECT_EQ(saved_tunnel().diameter_mm, start_mm);
}

// Shift+K, a name, Enter: typed letters are no keys meanwhile.
TEST_F(PlanWindow, AVersionGetsAName) {
  const VirtualDisplay display(1600, 900);
  RunningWorkstation app(display, folder_.path());
  open(app);
  app.press("k");
  ASSERT_TRUE(app.wait_for_state("hint", "Kept as version 1. Shift+K gives it a name and a note"));
  app.press("shift+k");
  ASSERT_TRUE(app.wait_for_widget("plan.version_name"));
  app.type("sniper");
  app.press("Return");
  for (int i = 0; i < 200 && cases::load_plan_versions(case_folder()).front().words.name.empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(cases::load_plan_versions(case_folder()).front().words.name, "sniper");
  EXPECT_EQ(app.state("undo"), "");
}

// The slices go with the tunnel, and turn about it.
TEST_F(PlanWindow, SlicesFollowTheTunnel) {
  cases::Case knee = cases::load_case(case_folder());
  images::Volume volume;
  volume.size = {60, 60, 60};
  volume.modality_in_file = "CT";
  volume.lps_from_index.linear() *= 2.5;
  volume.lps_from_index.translation() = Eigen::Vector3d(-75, -75, -75);
  for (int i = 0; i < 60 * 60 * 60; ++i) volume.values.push_back(static_cast<float>(i % 60 * 20));
  knee.images.push_back({.file = "",
                         .modality = volume.modality_in_file,
                         .source = "NRRD",
                         .size = volume.size,
                         .spacing_mm = volume.spacing_mm()});
  cases::store_image(case_folder(), 1, images::encoded(volume), knee.images.back());
  cases::save_case(case_folder(), knee);
  const VirtualDisplay display(1600, 900);
  RunningWorkstation app(display, folder_.path());
  open(app);
  app.press("s");
  ASSERT_TRUE(app.wait_for_state("slices", "shown"));
  EXPECT_EQ(app.state("along"), "");
  app.press("0");
  ASSERT_TRUE(app.wait_for_state("along", "femoral 0"));
  app.press("ctrl+Right");
  EXPECT_TRUE(app.wait_for_state("along", "femoral 5"));
  const std::string at_entry = app.state("cross");
  app.scroll_up("plan.sagittal_slice");
  EXPECT_TRUE(app.wait_for_state("along", "femoral 10") || app.wait_for_state("along", "femoral 0"));
  EXPECT_EQ(app.state("cross"), at_entry) << "a turn leaves the place on the axis";
  app.scroll_up("plan.axial_slice");
  for (int i = 0; i < 100 && app.state("cross") == at_entry; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_NE(app.state("cross"), at_entry) << "across it the wheel goes along it";
  // To where the wall is thinnest, on the axis; the slices turn there.
  const tunnels::Tunnel tunnel = knee.plan.tunnels.at(bones::BoneKind::Femur);
  const geometry::Surface femur(knee.bones.at(bones::BoneKind::Femur).mesh);
  const double depth_mm =
      (tunnels::measure(tunnel, femur).thinnest_mm - tunnel.entry_mm).dot(tunnel.direction);
  const auto depth_of_cross_mm = [&] {
    // As it is printed: with the minus sign of a figure.
    std::istringstream words(std::regex_replace(app.state("cross"), std::regex("\u2212"), "-"));
    Eigen::Vector3d cross_mm;
    words >> cross_mm.x() >> cross_mm.y() >> cross_mm.z();
    return (cross_mm - tunnel.entry_mm).dot(tunnel.direction);
  };
  constexpr double kAsPrinted_mm = 0.1;
  app.press("shift+e");
  for (int i = 0; i < 100 && std::abs(depth_of_cross_mm() - depth_mm) > kAsPrinted_mm; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_NEAR(depth_of_cross_mm(), depth_mm, kAsPrinted_mm);
  app.press("0");
  EXPECT_TRUE(app.wait_for_state("along", ""));
}

}  // namespace
}  // namespace arthronaut::test
