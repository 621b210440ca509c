// The map of how the graft's length changes, from outside, as a hand works it.
#include <gtest/gtest.h>

#include "planning/cases/bone_doubts.h"
#include "tests/app/window/plan_window.h"

namespace arthronaut::test {
namespace {

// Shift+M turns to the wall of the notch and draws the map; the mouse reads it beside the entry, an edit of
// the femoral entry leaves it, the tibia has none, and without a tibial entry it says so.
TEST_F(PlanWindow, TheMapOfLengthsIsReadOnTheWallOfTheNotch) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  EXPECT_EQ(app.state("isometry"), "none");
  app.press("shift+m");
  ASSERT_TRUE(app.wait_for_state("view_direction", "notch"));
  ASSERT_TRUE(app.wait_for_state("isometry", "shown"));
  const auto [x, y] = middle(app, "plan.entry_handle");
  std::string here;
  for (int away = 25; away < 60 && here.empty(); away += 5) {
    app.click_at(x, y - away);
    (void)app.wait_for_state("isometry_here", "", 0.5);
    here = app.state("isometry_here");
  }
  EXPECT_TRUE(here.starts_with("A graft that begins here changes by ")) << here;
  EXPECT_NE(here.find(" mm from 0 to 120 deg, longest at "), std::string::npos) << here;

  const std::size_t before = app.frames().size();
  app.press("shift+Up");
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  for (std::size_t i = before; i < app.frames().size(); ++i)
    EXPECT_FALSE(app.frames()[i].states.contains("isometry")) << "another one than shown";

  app.press("Tab");
  ASSERT_TRUE(app.wait_for_state("isometry", "none"));
  app.press("Delete");
  ASSERT_TRUE(app.wait_for_state("undo", "Remove the tibial tunnel"));
  app.press("Tab");
  EXPECT_TRUE(
      app.wait_for_state("isometry", "\"Length over flexion\" is not checked: the tibial tunnel is missing"));
  app.press("ctrl+z");
  app.press("Tab");
  ASSERT_TRUE(app.wait_for_state("isometry", "shown"));
  app.press("m");
  ASSERT_TRUE(app.wait_for_state("survey", "shown"));
  EXPECT_EQ(app.state("isometry"), "none") << "one map at a time";
}

// Of the other knee the lateral wall would be the medial one.
TEST_F(PlanWindow, NoMapOfLengthsWhileTheSideIsInDoubt) {
  const cases::SideDoubt doubt{cases::SideWitness::Fibula, bones::Side::Left, bones::Side::Right};
  cases::save_bone_doubts(case_folder(), {{bones::BoneKind::Femur, {doubt}}});
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  app.press("shift+m");
  EXPECT_TRUE(app.wait_for_state("isometry", "the side is in doubt: " + doubt.words()));
}

}  // namespace
}  // namespace arthronaut::test
