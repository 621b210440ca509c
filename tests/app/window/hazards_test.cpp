// What a hand does by accident, a screen that stands still, and what the room must see: on the real window.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/app/window/built_in_case.h"
#include "tests/app/window/display.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

class WorkstationHazards : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
    put_built_in_case(folder_ / "arthronaut" / "Phantom.arthro");
  }
  // Navigate shows the pictures of the simulated operation.
  static void start_operation(const RunningWorkstation& app) {
    ASSERT_TRUE(app.wait_for_state("case", "open", 120));
    app.press("F2");
    ASSERT_TRUE(app.wait_for_state("mode", "navigate"));
    app.press("space");
    ASSERT_TRUE(app.wait_for_state("picture", "live", 120));
  }
  // Whatever is not needed at every moment stands there.
  static void open_menu(const RunningWorkstation& app) {
    app.press("Return");
    ASSERT_TRUE(app.wait_for_state("menu", "open"));
    ASSERT_TRUE(app.wait_for_widget("navigate.stop"));
  }
  const TemporaryFolder folder_;
};

// Esc, Tab, Ctrl+Q, another source and a click on Stop, each pressed shortly: the operation goes on, and the
// screen says what to do. Held, they do it.
TEST_F(WorkstationHazards, Hazard22KeysThatEndTheOperationMustBeHeld) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_operation(app);
  open_menu(app);
  app.press("Escape");
  EXPECT_TRUE(app.wait_for_state("hold", "Hold Esc to stop (let go)"));
  // It stands over the steps: beside the picture, and above what is asked and every number.
  const auto widgets = app.widgets();
  ASSERT_TRUE(widgets.contains("hold_hint"));
  const Area &hint = widgets.at("hold_hint"), &video = widgets.at("navigate.video_panel");
  EXPECT_GE(hint.x, video.x + video.width);
  EXPECT_LE(hint.y + hint.height, widgets.at("navigate.words").y);
  app.press("ctrl+q");
  EXPECT_TRUE(app.wait_for_state("hold", "Hold Ctrl+Q to quit (let go)"));
  app.press("g");
  EXPECT_TRUE(app.wait_for_state("hold", "Hold G to start the simulation instead (let go)"));
  app.press("Tab");
  EXPECT_TRUE(app.wait_for_state("notice", "Stop the source first, then take the other bone"));
  app.click("navigate.stop");
  EXPECT_TRUE(app.wait_for_state("hold", "Hold Esc to stop (let go)"));
  EXPECT_TRUE(app.wait_for_state("picture", "live")) << "it goes on";
  EXPECT_EQ(app.wait_for_exit(0.1), -1);
  // The last picture stays, and is called so.
  ASSERT_TRUE(app.hold_click_until("navigate.stop", "guidance", "The pictures have ended"));
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("picture", "live", 120));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// The mark moves in every mode, in the same place; a screen that stood still while an operation ran says so
// as soon as it moves again.
TEST_F(WorkstationHazards, Hazard17AScreenThatStandsStillIsSeenAndTold) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  ASSERT_TRUE(app.wait_for_widget("app.heartbeat"));
  const Area heart = app.widgets().at("app.heartbeat");
  for (const auto& [mode, key] : {std::pair{"plan", "F1"}, std::pair{"set up", "F4"},
                                  std::pair{"navigate", "F2"}, std::pair{"review", "F3"}}) {
    app.press(key);
    ASSERT_TRUE(app.wait_for_state("mode", mode));
    const Area here = app.widgets().at("app.heartbeat");
    EXPECT_TRUE(here.x == heart.x && here.y == heart.y) << mode;
    const Picture before = app.screenshot();
    bool has_moved = false;
    for (int i = 0; i < 10 && !has_moved; ++i) {
      const Picture after = app.screenshot();
      for (int y = heart.y; y < heart.y + heart.height; ++y)
        for (int x = heart.x; x < heart.x + heart.width; ++x)
          has_moved = has_moved || before.at(x, y) != after.at(x, y);
    }
    EXPECT_TRUE(has_moved) << mode;
  }
  EXPECT_EQ(app.state("standstill"), "");
  start_operation(app);
  app.freeze(1.2);
  bool is_told = false;
  for (int i = 0; i < 200 && !is_told; ++i) {
    is_told = app.state("standstill").starts_with("The screen stood still for ");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(is_told);
}

// The kind of source stands in letters of 30 px and more at 1080 lines (16' at 2 m on 27 inches) and as a
// frame about the whole window, in the place where it stands in every mode; without a source neither does.
TEST_F(WorkstationHazards, Hazard2TheKindOfSourceIsSeenFromAfar) {
  const VirtualDisplay display(1920, 1080);
  RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  EXPECT_TRUE(app.wait_for_state("source_kind", "none"));
  EXPECT_FALSE(app.widgets().contains("app.source"));
  start_operation(app);
  ASSERT_TRUE(app.wait_for_state("source_kind", "SIMULATION"));
  ASSERT_TRUE(app.wait_for_widget("app.source"));
  const Area word = app.widgets().at("app.source");
  const Picture screen = app.screenshot();
  int first = -1, last = -1;
  for (int y = word.y; y < word.y + word.height; ++y)
    for (int x = word.x + 8; x < word.x + word.width - 8; ++x) {
      const auto pixel = screen.at(x, y);
      if (pixel[0] + pixel[1] + pixel[2] > 120) continue;
      if (first < 0) first = y;
      last = y;
    }
  EXPECT_GE(last - first + 1, 30);
  // Dashes as long as their gaps, along all of the left and the lower edge.
  const auto is_frame = [](const std::array<int, 3>& c) {
    return c[0] > 150 && c[0] > c[1] + 40 && c[2] > c[1] + 20;
  };
  int left = 0, lower = 0;
  for (int y = 0; y < screen.height; ++y) left += is_frame(screen.at(3, y)) ? 1 : 0;
  for (int x = 0; x < screen.width; ++x) lower += is_frame(screen.at(x, screen.height - 4)) ? 1 : 0;
  EXPECT_NEAR(left, screen.height / 2, screen.height / 10);
  EXPECT_NEAR(lower, screen.width / 2, screen.width / 10);
  // In Plan nothing of a source is shown.
  app.press("F1");
  EXPECT_TRUE(app.wait_for_state("source_kind", "none"));
}

}  // namespace
}  // namespace arthronaut::test
