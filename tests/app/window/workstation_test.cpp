// Drives the real window from outside, as a user does. Slow machines are waited for: what is tested is what
// happens, not how fast.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/app/window/theatre.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

class Workstation : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
  }
  [[nodiscard]] std::string saved_plan() const {
    std::ifstream stream(folder_ / "arthronaut" / "Phantom.arthro" / "plan.json");
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  const TemporaryFolder folder_;
};

// The share of an area's pixels for which `holds`.
template <typename Predicate>
double share(const Picture& picture, const Area& area, const Predicate& holds) {
  long count = 0;
  for (int y = area.y; y < area.y + area.height; ++y)
    for (int x = area.x; x < area.x + area.width; ++x) count += holds(picture.at(x, y)) ? 1 : 0;
  return static_cast<double>(count) / (static_cast<double>(area.width) * area.height);
}

bool is_bone(const std::array<int, 3>& c) { return c[0] > 70 && c[0] > c[2] + 12; }

// One walk through the whole program: plan (aim, undo, autosave), navigate (a live picture, then none),
// review, quit.
TEST_F(Workstation, LeadsThroughItsThreeModes) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  ASSERT_TRUE(app.wait_for_widget("plan.view"));
  const Picture before = app.screenshot();
  EXPECT_GT(share(before, app.widgets().at("plan.view"), is_bone), 0.05);

  // Aiming changes plan and file; undo and redo walk between the two states exactly.
  const auto aim = [&] {
    app.press("Right");
    ASSERT_TRUE(app.wait_for_state("undo", "Aim the femoral tunnel"));
    ASSERT_TRUE(app.wait_for_state("plan", "saved"));
  };
  const auto undo = [&] {
    app.press("ctrl+z");
    ASSERT_TRUE(app.wait_for_state("redo", "Aim the femoral tunnel"));
  };
  aim();
  const std::string plan_aimed = saved_plan();
  undo();
  const std::string plan_before = saved_plan();
  EXPECT_NE(plan_aimed, plan_before);
  app.press("ctrl+y");
  ASSERT_TRUE(app.wait_for_state("redo", ""));
  EXPECT_EQ(saved_plan(), plan_aimed);
  undo();
  EXPECT_EQ(saved_plan(), plan_before);

  // A drag over the bone turns it: many pixels change, the plan does not.
  const Area view = app.widgets().at("plan.view");
  app.drag(view.x + view.width / 5, view.y + view.height * 4 / 5, view.x + view.width / 2,
           view.y + view.height * 3 / 5);
  const Picture after = app.screenshot();
  long changed = 0;
  for (std::size_t i = 0; i < before.rgb.size(); i += 3) changed += before.rgb[i] != after.rgb[i] ? 1 : 0;
  EXPECT_GT(changed, 10'000);
  EXPECT_EQ(saved_plan(), plan_before);

  app.click("mode.navigate");
  ASSERT_TRUE(app.wait_for_state("mode", "navigate"));
  EXPECT_EQ(app.state("guidance"), "No picture");
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("picture", "live", 120));
  // Nothing is registered: no number may stand, and the reason does.
  ASSERT_TRUE(app.wait_for_state("guidance", "Not registered"));
  ASSERT_TRUE(app.wait_for_widget("navigate.video_panel"));
  const Picture live = app.screenshot();
  const auto is_lit = [](const std::array<int, 3>& c) { return c[0] + c[1] + c[2] > 120; };
  EXPECT_GT(share(live, app.widgets().at("navigate.video_panel"), is_lit), 0.2);
  EXPECT_EQ(app.state("layout"), "register");
  // The view without distortion is another picture of the same scene, as bright.
  app.press("u");
  ASSERT_TRUE(app.wait_for_state("view", "undistorted"));
  EXPECT_GT(share(app.screenshot(), app.widgets().at("navigate.video_panel"), is_lit), 0.2);
  // A source that was stopped leaves its last picture, dimmed and called so: what was made of it stays.
  ASSERT_TRUE(app.hold_until("Escape", "guidance", "The pictures have ended"));
  // A machine without a camera asks for the address of a stream, and takes no for an answer.
  if (!std::filesystem::exists("/dev/video0")) {
    app.press("k");
    ASSERT_TRUE(app.wait_for_state("cameras", "address"));
    app.press("Escape");
    ASSERT_TRUE(app.wait_for_state("cameras", "none"));
  }

  app.press("F3");
  ASSERT_TRUE(app.wait_for_state("mode", "review"));
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
}

bool overlap(const Area& a, const Area& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

// At every size of screen all buttons lie inside the window and none over another, in all modes.
// A window that was made smaller and larger again is drawn anew each time, over all of itself.
TEST_F(Workstation, IsDrawnInWhateverSizeItIsGiven) {
  const VirtualDisplay display(1920, 1080);
  RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  for (const auto& [width, height] : {std::pair{1280, 720}, std::pair{1600, 900}}) {
    const std::string resize = "DISPLAY=" + display.name() +
                               " xdotool search --name Arthronaut windowsize --sync %@ " +
                               std::to_string(width) + " " + std::to_string(height);
    ASSERT_EQ(std::system(resize.c_str()), 0);
    const auto fills = [&, w = width] {
      const auto widgets = app.widgets();
      const auto quit = widgets.find("app.quit");
      return quit != widgets.end() && quit->second.x + quit->second.width > w - 40 &&
             quit->second.x + quit->second.width <= w;
    };
    ASSERT_TRUE(becomes(fills, 20)) << width;
    const auto shown = [&](bool with_bone) {
      const auto widgets = app.widgets();
      const auto view = widgets.find("plan.view");
      const Area area = view != widgets.end() ? view->second : Area{0, 0, width, height};
      return (share(app.screenshot(), area, is_bone) > 0.05) == with_bone;
    };
    EXPECT_TRUE(becomes([&] { return shown(true); }, 20)) << width;
    app.press("F4");
    ASSERT_TRUE(app.wait_for_state("mode", "set up"));
    EXPECT_TRUE(becomes([&] { return shown(false); }, 20)) << width;
    app.press("F1");
    ASSERT_TRUE(app.wait_for_state("mode", "plan"));
    EXPECT_TRUE(becomes([&] { return shown(true); }, 20)) << width;
  }
}

class WorkstationLayout : public Workstation, public ::testing::WithParamInterface<std::pair<int, int>> {};

TEST_P(WorkstationLayout, HoldsAtEverySize) {
  const auto [width, height] = GetParam();
  const VirtualDisplay display(width, height);
  RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  for (const auto& [mode, key] : {std::pair{"plan", "F1"}, std::pair{"set up", "F4"},
                                  std::pair{"navigate", "F2"}, std::pair{"review", "F3"}}) {
    app.press(key);
    ASSERT_TRUE(app.wait_for_state("mode", mode));
    const std::map<std::string, std::string> own{{"plan", "plan.undo"},
                                                 {"set up", "setup.next"},
                                                 {"navigate", "navigate.next"},
                                                 {"review", "review.report"}};
    ASSERT_TRUE(app.wait_for_widget(own.at(mode)));
    const auto widgets = app.widgets();
    for (auto a = widgets.begin(); a != widgets.end(); ++a) {
      if (a->first.ends_with("_handle")) continue;  // lies on the 3D view on purpose
      EXPECT_TRUE(a->second.x >= 0 && a->second.y >= 0 && a->second.x + a->second.width <= width &&
                  a->second.y + a->second.height <= height)
          << a->first << " leaves the window in " << mode;
      for (auto b = std::next(a); b != widgets.end(); ++b) {
        if (b->first.ends_with("_handle")) continue;
        EXPECT_FALSE(overlap(a->second, b->second)) << a->first << " and " << b->first << " in " << mode;
      }
    }
  }
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
}

INSTANTIATE_TEST_SUITE_P(Screens, WorkstationLayout,
                         ::testing::Values(std::pair{1280, 720}, std::pair{1920, 1080},
                                           std::pair{3840, 2160}));

}  // namespace
}  // namespace arthronaut::test
