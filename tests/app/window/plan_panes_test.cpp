// Plan mode's pictures: the rows of buttons above them, and all that the mouse does in them by keys.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "planning/cases/measurements.h"
#include "tests/app/window/plan_window.h"

namespace arthronaut::test {
namespace {

// The cross-hair as the window's log has it.
Eigen::Vector3d cross_of(const RunningWorkstation& app) {
  std::string text = app.state("cross");
  const std::string minus = "\u2212";
  for (std::size_t at = text.find(minus); at != std::string::npos; at = text.find(minus))
    text.replace(at, minus.size(), "-");
  std::istringstream numbers(text);
  Eigen::Vector3d cross;
  numbers >> cross.x() >> cross.y() >> cross.z();
  return cross;
}

// By how much a key moves it.
Eigen::Vector3d moved_by(const RunningWorkstation& app, const std::string& key) {
  const Eigen::Vector3d before = cross_of(app);
  app.press(key);
  for (int i = 0; i < 500 && cross_of(app) == before; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return cross_of(app) - before;
}

// Without a mouse: a slice is scrolled by an image, the cross-hair goes right and down in it, a distance is
// measured between two places of it, and an entry is placed at the cross-hair.
TEST_F(PlanWindow, SlicesGoByKeysAlone) {
  const auto folder = folder_ / "Imaged.arthro";
  write_knee_with_ct(folder);
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {folder.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("s");
  ASSERT_TRUE(app.wait_for_widget("plan.axial_slice", 60));
  ASSERT_TRUE(app.wait_for_state("keyed_pane", "0"));
  app.press("shift+s");
  ASSERT_TRUE(app.wait_for_state("keyed_pane", "1"));
  EXPECT_NEAR(std::abs(moved_by(app, "shift+Prior").z()), 1.5, 0.11) << "one image";
  EXPECT_NEAR(std::abs(moved_by(app, "shift+Next").z()), 1.5, 0.11);
  const Eigen::Vector3d right = moved_by(app, "alt+Right"), down = moved_by(app, "alt+Down");
  EXPECT_GT(right.x(), 0.1);  // the axial slice from the feet: the patient's left is at the right
  EXPECT_EQ(right.z(), 0);
  EXPECT_GT(down.y(), 0.1);
  // Nearer, a press moves it less.
  for (int i = 0; i < 8; ++i) app.press("ctrl+equal");
  EXPECT_LT(moved_by(app, "alt+Right").x(), 0.75 * right.x());
  for (int i = 0; i < 8; ++i) app.press("ctrl+minus");
  app.press("d");
  app.press("space");
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  for (int i = 0; i < 6; ++i) way += moved_by(app, "alt+Left");
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("undo", "Measure a distance"));
  const auto measured = cases::load_measurements(folder);
  ASSERT_EQ(measured.size(), 1U);
  EXPECT_NEAR(measured[0].distance_mm(), way.norm(), 0.5);
  app.press("Escape");
  // At the entry, a little aside: on the bone's surface near it.
  app.press("e");
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("placing", "entry"));
  (void)moved_by(app, "alt+Down");
  app.press("space");
  EXPECT_TRUE(app.wait_for_state("undo", "Place the entry of the femoral tunnel")) << app.state("hint");
}

// So is the 3D view turned, and an entry placed under the cross in its middle; versions are chosen and taken.
TEST_F(PlanWindow, TheViewAndTheVersionsGoByKeysAlone) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  open(app);
  app.press("k");
  ASSERT_TRUE(app.wait_for_state("version_row", ""));
  app.press("5");
  ASSERT_TRUE(app.wait_for_state("view_direction", "distal"));
  const Area before = app.widgets().at("plan.entry_handle");
  app.press("alt+Left");
  ASSERT_TRUE(app.wait_for_state("view_direction", "turned by hand"));
  app.press("alt+Right");
  ASSERT_TRUE(app.wait_for_state("view_direction", "distal"));
  app.press("ctrl+shift+Right");
  const auto has_moved = [&] {
    for (int i = 0; i < 500; ++i) {
      if (app.widgets().at("plan.entry_handle").x > before.x + 10) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  };
  EXPECT_TRUE(has_moved());
  app.press("ctrl+shift+Left");
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("placing", "entry"));
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("undo", "Place the entry of the femoral tunnel")) << app.state("hint");
  app.press("k");
  app.press("h");
  ASSERT_TRUE(app.wait_for_state("version_row", "2"));
  app.press("Next");
  ASSERT_TRUE(app.wait_for_state("version_row", "1"));
  app.press("Return");
  EXPECT_TRUE(app.wait_for_state("undo", "Take version 1"));
  app.press("k");  // the newest is the one that Shift+K names
  EXPECT_TRUE(app.wait_for_state("version_row", "3"));
}

// Beside the slices, too, every button of the rows lies beside the panel and over no other: two of them ran
// under it.
TEST_F(PlanWindow, NoButtonOfTheRowsRunsUnderThePanel) {
  const auto folder = folder_ / "Imaged.arthro";
  write_knee_with_ct(folder);
  for (const auto& [width, height] :
       {std::pair{1024, 768}, {1280, 800}, {1366, 768}, {1920, 1080}, {3840, 2160}}) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    const VirtualDisplay display(width, height);
    RunningWorkstation app(display, folder_.path(), {folder.string()});
    ASSERT_TRUE(app.wait_for_state("case", "open", 120));
    ASSERT_TRUE(app.wait_for_widget("plan.view"));
    app.press("s");
    ASSERT_TRUE(app.wait_for_widget("plan.sagittal_slice", 60));
    app.press("v");
    ASSERT_TRUE(app.wait_for_state("volume", "Images: bone above 250 HU (, less, . more)", 120));
    ASSERT_TRUE(app.wait_for_widget("plan.volume_more"));
    const auto widgets = app.widgets();
    const Area slice = widgets.at("plan.sagittal_slice");
    std::vector<std::pair<std::string, Area>> buttons;
    for (const char* name :
         {"plan.anterior", "plan.plateau", "plan.see_through", "plan.grid", "plan.xray", "plan.volume",
          "plan.volume_less", "plan.volume_more", "plan.slices", "plan.paint", "plan.along", "plan.window",
          "plan.fit", "plan.cross_to_thinnest", "plan.distance", "plan.angle", "plan.unmeasure"})
      buttons.emplace_back(name, widgets.at(name));
    for (std::size_t i = 0; i < buttons.size(); ++i) {
      const auto& [name, area] = buttons[i];
      EXPECT_LE(area.x + area.width, slice.x + slice.width) << name;
      EXPECT_LE(area.y + area.height, widgets.at("plan.view").y) << name;
      for (std::size_t j = 0; j < i; ++j) {
        const Area& other = buttons[j].second;
        EXPECT_FALSE(area.x < other.x + other.width && other.x < area.x + area.width &&
                     area.y < other.y + other.height && other.y < area.y + area.height)
            << name << " over " << buttons[j].first;
      }
    }
  }
}

}  // namespace
}  // namespace arthronaut::test
