// The first-case tour, gone through by a hand on the built-in knee.
#include <gtest/gtest.h>

#include "planning/cases/plan_versions.h"
#include "tests/app/window/display.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

class TourWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
  }
  const TemporaryFolder folder_;
};

// Offered at the first start; every step by what it asks for; left and taken up in between, over a restart.
TEST_F(TourWindow, LeadsFromTheFirstLookToAKeptPlan) {
  const VirtualDisplay display(1280, 720);
  {
    RunningWorkstation app(display, folder_.path());
    ASSERT_TRUE(app.wait_for_state("case", "open", 120));
    ASSERT_TRUE(app.wait_for_state("tour", "0 A first case?"));
    app.press("F9");
    ASSERT_TRUE(app.wait_for_state("tour", "1 Turn the knee"));
    app.press("6");
    ASSERT_TRUE(app.wait_for_state("tour", "2 Look at the landmarks"));
    app.press("F9");
    ASSERT_TRUE(app.wait_for_state("tour", ""));
    app.press("l");  // not the tour's while it is left
    app.press("ctrl+q");
    EXPECT_EQ(app.wait_for_exit(60), 0);
  }
  RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  ASSERT_TRUE(app.wait_for_widget("plan.entry_handle"));
  EXPECT_EQ(app.state("tour"), "");
  app.press("F9");
  ASSERT_TRUE(app.wait_for_state("tour", "2 Look at the landmarks"));
  app.press("l");
  ASSERT_TRUE(app.wait_for_state("tour", "3 Make the default plan"));
  app.press("n");
  ASSERT_TRUE(app.wait_for_state("tour", "4 Move a tunnel", 60));
  app.press("6");
  ASSERT_TRUE(app.wait_for_state("view_direction", "notch"));
  ASSERT_TRUE(app.wait_for_widget("plan.entry_handle"));
  const Area handle = app.widgets().at("plan.entry_handle");
  const int x = handle.x + handle.width / 2, y = handle.y + handle.height / 2;
  app.drag(x, y, x + 6, y);
  ASSERT_TRUE(app.wait_for_state("tour", "5 Read the checks of both bones"));
  app.press("Tab");
  ASSERT_TRUE(app.wait_for_state("tour", "6 Take a step back"));
  app.press("ctrl+z");
  ASSERT_TRUE(app.wait_for_state("tour", "7 Keep this version"));
  app.press("k");
  ASSERT_TRUE(app.wait_for_state("tour", "8 That is planning"));
  EXPECT_EQ(cases::load_plan_versions(folder_ / "arthronaut" / "Phantom.arthro").size(), 1U);
  app.press("F4");
  ASSERT_TRUE(app.wait_for_state("mode", "set up"));
  app.press("F1");
  ASSERT_TRUE(app.wait_for_state("mode", "plan"));
  ASSERT_TRUE(app.wait_for_state("tour", ""));
}

// A click is enough to be rid of the offer for good.
TEST_F(TourWindow, IsNotOfferedAgain) {
  const VirtualDisplay display(1280, 720);
  {
    RunningWorkstation app(display, folder_.path());
    ASSERT_TRUE(app.wait_for_widget("plan.no_tour", 120));
    app.click("plan.no_tour");
    ASSERT_TRUE(app.wait_for_state("tour", ""));
    app.press("ctrl+q");
    EXPECT_EQ(app.wait_for_exit(60), 0);
  }
  RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  ASSERT_TRUE(app.wait_for_widget("plan.entry_handle"));
  EXPECT_EQ(app.state("tour"), "");
}

}  // namespace
}  // namespace arthronaut::test
