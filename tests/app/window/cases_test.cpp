// The list of cases as a hand works it.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "app/library/case_thumbnail.h"
#include "planning/cases/case.h"
#include "planning/cases/case_note.h"
#include "planning/phantom/phantom_case.h"
#include "tests/app/window/display.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

namespace fs = std::filesystem;

class CasesWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
    for (const char* name : {"Anton", "Berta", "Caesar"})
      cases::save_case(case_folder(name),
                       phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), name));
  }
  // Where imported cases go, which is known without being added.
  [[nodiscard]] fs::path case_folder(const std::string& name) const {
    return folder_ / "arthronaut" / "cases" / (name + ".arthro");
  }
  const TemporaryFolder folder_;
};

// By keys: search, choose, note, trends and back, open. What is typed into the fields does nothing else.
TEST_F(CasesWindow, IsSearchedNotedAndOpenedByKeys) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {"--frames", "0"});
  ASSERT_TRUE(app.wait_for_state("cases_listed", "3"));
  app.press("f");
  app.type("bert");
  ASSERT_TRUE(app.wait_for_state("cases_listed", "1"));
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("cases_listed", "3")) << "the search is cleared";
  // Nobody is like that: no other knee stands in, and nothing is opened.
  app.press("f");
  app.type("schmidt");
  ASSERT_TRUE(app.wait_for_state("cases_listed", "0"));
  EXPECT_EQ(app.state("case_selected"), "none");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("typing", "no"));
  app.press("Return");
  app.press("f");  // the words of before are replaced
  app.type("bert");
  ASSERT_TRUE(app.wait_for_state("case_selected", "Berta"));
  ASSERT_TRUE(app.wait_for_state("cases_listed", "1"));
  EXPECT_EQ(app.state("case"), "none") << "B and O were letters";
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("typing", "no"));
  app.press("n");
  app.type("second look");
  app.press("ctrl+Return");
  ASSERT_TRUE(app.wait_for_state("note", "second look"));
  ASSERT_TRUE(app.wait_for_state("typing", "no"));
  EXPECT_EQ(cases::load_note(case_folder("Berta")).text, "second look");
  app.press("t");
  ASSERT_TRUE(app.wait_for_state("page", "trends"));
  ASSERT_TRUE(app.wait_for_state("trend_bone", "both"));
  for (const char* bone : {"femur", "tibia", "both"}) {
    app.press("Tab");
    ASSERT_TRUE(app.wait_for_state("trend_bone", bone));
  }
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("page", "list"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("folder", case_folder("Berta").string(), 120));
  EXPECT_EQ(app.state("case"), "open");
}

// By mouse; thumbnails come by themselves and are kept with the cases; Esc leaves a note as it was.
TEST_F(CasesWindow, IsWorkedByMouseAndMakesThumbnails) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {"--frames", "0"});
  ASSERT_TRUE(app.wait_for_state("library", "ready"));
  ASSERT_TRUE(app.wait_for_widget("start.case.3"));  // the built-in knee is the last
  app.click("start.order");
  ASSERT_TRUE(app.wait_for_state("order", "name"));
  app.click("start.case.2");
  ASSERT_TRUE(app.wait_for_state("case_selected", "Caesar"));
  app.click("start.note_field");
  ASSERT_TRUE(app.wait_for_state("typing", "yes"));
  app.type("not kept");
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("typing", "no"));
  app.click("start.side");  // left: none
  ASSERT_TRUE(app.wait_for_state("cases_listed", "0"));
  app.click("start.side");  // right
  ASSERT_TRUE(app.wait_for_state("cases_listed", "3"));
  EXPECT_FALSE(fs::exists(cases::note_file(case_folder("Caesar"))));
  for (int tenths = 0; tenths < 600 && !workstation_library::has_thumbnail(case_folder("Anton")); ++tenths)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_TRUE(workstation_library::has_thumbnail(case_folder("Anton")));
}

// A case that goes stays in the list as missing, cannot be opened unnoticed, and leaves when it is told to.
TEST_F(CasesWindow, SaysThatACaseIsMissing) {
  const VirtualDisplay display(1280, 720);
  {
    RunningWorkstation app(display, folder_.path(), {"--frames", "0"});
    ASSERT_TRUE(app.wait_for_state("cases_listed", "3"));
    app.press("ctrl+q");
    EXPECT_EQ(app.wait_for_exit(60), 0);
  }
  fs::rename(case_folder("Anton"), folder_ / "elsewhere");
  RunningWorkstation app(display, folder_.path(), {"--frames", "0"});
  ASSERT_TRUE(app.wait_for_state("library", "ready"));
  app.press("f");
  app.type("missing");
  ASSERT_TRUE(app.wait_for_state("case_selected", "Anton"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("typing", "no"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("case", "failed"));
  EXPECT_EQ(app.state("screen"), "start");
  app.press("Delete");
  ASSERT_TRUE(app.wait_for_state("cases_listed", "0"));
  EXPECT_TRUE(fs::exists(folder_ / "elsewhere" / "case.json"));
}

}  // namespace
}  // namespace arthronaut::test
