#include "app/folders/folder_browser.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/temporary_folder.h"

namespace arthronaut::folders {
namespace {

// A user's own folder: a folder of slices beside a mesh.
class FolderBrowserTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* const home = std::getenv("HOME");
    home_before_ = home == nullptr ? "" : home;
    ASSERT_EQ(setenv("HOME", home_.path().c_str(), 1), 0);
    std::filesystem::create_directories(home_ / "after/ct");
    std::ofstream(home_ / "femur.stl") << "x";
    browser_.enter();
  }
  void TearDown() override { ASSERT_EQ(setenv("HOME", home_before_.c_str(), 1), 0); }

  test::TemporaryFolder home_;
  std::string home_before_;
  FolderBrowser browser_{"test"};
};

// What is typed is gone to like what is clicked on; a slip is said, and changes nothing.
TEST_F(FolderBrowserTest, GoesToWhatIsTyped) {
  EXPECT_EQ(browser_.go_to((home_ / "femur.stl").string()), home_ / "femur.stl");
  EXPECT_EQ(browser_.go_to("after/ct/"), std::nullopt);
  EXPECT_EQ(browser_.folder(), home_ / "after/ct");
  EXPECT_EQ(browser_.go_to("../mr"), std::nullopt);
  EXPECT_EQ(browser_.folder(), home_ / "after/ct");
  EXPECT_NE(browser_.typing_problem().find("There is no " + (home_ / "after/mr").string()),
            std::string::npos);
  EXPECT_EQ(browser_.go_to(".."), std::nullopt);
  EXPECT_EQ(browser_.typing_problem(), "");
  EXPECT_EQ(browser_.folder(), home_ / "after");
}

TEST_F(FolderBrowserTest, BeginsAtHomeAndComesBackToWhereItWas) {
  EXPECT_EQ(browser_.folder(), home_.path());
  EXPECT_EQ(browser_.selected(), "after");
  EXPECT_EQ(browser_.open_selected(), std::nullopt);
  EXPECT_EQ(browser_.folder(), home_ / "after");
  browser_.enter();
  EXPECT_EQ(browser_.folder(), home_ / "after");
  browser_.home();
  EXPECT_EQ(browser_.folder(), home_.path());
}

TEST_F(FolderBrowserTest, SelectsWhereItCameFromWhenItGoesUp) {
  (void)browser_.open_selected();
  (void)browser_.open_selected();
  ASSERT_EQ(browser_.folder(), home_ / "after/ct");
  EXPECT_FALSE(browser_.has_rows());
  EXPECT_EQ(browser_.open_selected(), std::nullopt);  // an empty folder: nothing is selected
  browser_.up();
  EXPECT_EQ(browser_.selected(), "ct");
  browser_.up();
  EXPECT_EQ(browser_.selected(), "after");
}

TEST_F(FolderBrowserTest, GivesFilesToItsOwnerAndStopsAtTheEndsOfTheList) {
  browser_.move_selection(10);
  EXPECT_EQ(browser_.selected(), "femur.stl");
  EXPECT_EQ(browser_.open_selected(), home_ / "femur.stl");
  browser_.move_selection(-10);
  EXPECT_EQ(browser_.selected(), "after");
}

}  // namespace
}  // namespace arthronaut::folders
