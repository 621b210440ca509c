// Which knee the case is, said in Plan as a hand says it; and steps that outlive the program.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "planning/cases/bone_doubts.h"
#include "planning/import/import_side.h"
#include "tests/app/window/plan_window.h"

namespace arthronaut::test {
namespace {

using bones::Side;

// J asks, 8 and 9 answer: the case is opened anew as the other knee, without the plan of the first, which is
// back with it. What spoke for the other side leads there.
TEST_F(PlanWindow, Hazard52TheSideIsChangedAndBack) {
  cases::save_bone_doubts(
      case_folder(), {{bones::BoneKind::Femur, {importing::other_side_by_fibula(Side::Left, Side::Right)}}});
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

}  // namespace
}  // namespace arthronaut::test
