// Screenshot and video of the screen by key, on the real window.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "navigation/sources/frame_source.h"
#include "tests/app/window/display.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

class ScreenCopyKeys : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
  }
  static bool becomes_so(const std::function<bool()>& is_so) {
    for (int i = 0; i < 600; ++i) {
      if (is_so()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }
  static bool says(const RunningWorkstation& app, const std::string& what) {
    return becomes_so([&] { return app.state("screen_copy").find(what) != std::string::npos; });
  }
  // Of the case that is open.
  static std::vector<std::filesystem::path> copies(const RunningWorkstation& app,
                                                   const std::string& extension) {
    std::vector<std::filesystem::path> found;
    const std::filesystem::path folder = std::filesystem::path(app.state("folder")) / "screens";
    if (std::filesystem::exists(folder))
      for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == extension) found.push_back(entry.path());
    return found;
  }
  const TemporaryFolder folder_;
};

TEST_F(ScreenCopyKeys, PutWhatTheScreenShowsIntoTheCase) {
  const VirtualDisplay display(1280, 720);
  const RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  EXPECT_EQ(app.state("screen_copy"), "");
  app.press("F12");
  ASSERT_TRUE(says(app, "is in the case")) << app.state("screen_copy");
  ASSERT_EQ(copies(app, ".png").size(), 1U);
  const camera::Frame shot = sources::read_picture(copies(app, ".png").front());
  EXPECT_EQ(shot.width, 1280);
  EXPECT_EQ(shot.height, 720);
  // As another program sees the same screen: the mode's button in the bar above stands still.
  const Area button = app.widgets().at("mode.plan");
  const Picture screen = app.screenshot();
  const int x = button.x + 4, y = button.y + button.height / 2;
  const auto at = static_cast<std::size_t>(3 * (y * shot.width + x));
  EXPECT_EQ(screen.at(x, y), (std::array<int, 3>{shot.bgr[at + 2], shot.bgr[at + 1], shot.bgr[at]}));

  app.press("ctrl+F12");
  ASSERT_TRUE(says(app, "SCREEN IS RECORDED 0:02")) << app.state("screen_copy");
  app.press("ctrl+F12");
  ASSERT_TRUE(becomes_so([&] { return copies(app, ".mkv").size() == 1; })) << app.state("screen_copy");
  const auto video = sources::open_video(copies(app, ".mkv").front());
  EXPECT_EQ(video->info().image_size_px, Eigen::Vector2i(1280, 720));
  int count = 0;
  while (video->next() != nullptr) ++count;
  EXPECT_GE(count, 2);
  // The list of cases and a PACS name other patients, and the case's pictures go to the archive.
  app.press("F5");
  ASSERT_TRUE(app.wait_for_state("start", "cases"));
  app.press("F12");
  EXPECT_TRUE(says(app, "other patients may be named here")) << app.state("screen_copy");
  EXPECT_EQ(copies(app, ".png").size(), 1U);
  app.press("F5");
  // Nobody said where to.
  app.press("shift+F12");
  EXPECT_TRUE(says(app, "names no screen_stream")) << app.state("screen_copy");
}

}  // namespace
}  // namespace arthronaut::test
