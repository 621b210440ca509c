// The hospital's PACS as a hand works it: a peer typed in, the patient found, the series fetched and
// imported, the results of a case sent.
#include <gtest/gtest.h>

#include <filesystem>

#include "planning/cases/case.h"
#include "planning/files/atomic_file.h"
#include "planning/pacs/query.h"
#include "planning/phantom/phantom_case.h"
#include "tests/app/window/display.h"
#include "tests/planning/pacs/sent_series.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

namespace fs = std::filesystem;

class PacsWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
  }
  void write_peers(const Orthanc& orthanc) const {
    fs::create_directories(folder_ / "arthronaut");
    files::write_atomically(
        folder_ / "arthronaut/pacs.json",
        R"({"format": "arthronaut.pacs_peers", "version": 1, "peers": [{"name": "Archive", "peer": ")" +
            pacs::to_text(orthanc.peer()) + R"(", "our_ae_title": "ARTHRONAUT", "listening_port": )" +
            std::to_string(our_port_) + "}]}");
  }
  const TemporaryFolder folder_;
  const int our_port_ = free_port();
};

TEST_F(PacsWindow, TakesAPeerFindsThePatientAndImportsTheSeries) {
  const Orthanc orthanc;
  const TemporaryFolder made;
  write_and_send(orthanc, made / "ct");
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {"--frames", "0"});
  ASSERT_TRUE(app.wait_for_state("start", "cases"));
  ASSERT_TRUE(app.wait_for_widget("start.case.0"));
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("start", "pacs"));
  EXPECT_EQ(app.state("pacs_peer"), "none");
  app.press("a");
  ASSERT_TRUE(app.wait_for_state("pacs", "peer"));
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "yes"));
  app.type("Archive");
  app.press("Tab");
  ASSERT_TRUE(app.wait_for_state("pacs_field", "start.pacs.form.address"));
  app.type("no address");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("pacs_failure",
                                 "peer \"no address\": has no AE title; it is written AET@HOST:PORT"));
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "no"));
  app.click("start.pacs.form.address");
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "yes"));
  app.press("ctrl+a");
  app.type(pacs::to_text(orthanc.peer()));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("pacs", "search"));
  ASSERT_TRUE(app.wait_for_state("pacs_light", "good"));
  EXPECT_TRUE(fs::exists(folder_ / "arthronaut/pacs.json"));

  app.press("f");
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "yes"));
  app.type("4711");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("pacs_work", "find-done"));
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "no"));
  ASSERT_TRUE(app.wait_for_widget("start.pacs.series.2"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("start", "import"));
  ASSERT_TRUE(app.wait_for_state("import", "choosing", 120));
  ASSERT_TRUE(app.wait_for_widget("start.source.0"));
}

// A PACS that is away is said to be so, by light and by words; Esc leads back out.
TEST_F(PacsWindow, SaysThatThePacsIsAway) {
  auto orthanc = std::make_unique<Orthanc>();
  write_peers(*orthanc);
  orthanc->kill();
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {"--frames", "0"});
  ASSERT_TRUE(app.wait_for_widget("start.case.0"));
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("pacs_light", "bad"));
  EXPECT_NE(app.state("pacs_says").find("cannot be reached"), std::string::npos);
  orthanc->start();
  app.press("e");
  ASSERT_TRUE(app.wait_for_state("pacs_light", "good"));
  // A light stays green no longer than it was answered.
  orthanc->kill();
  app.press("f");
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "yes"));
  app.type("4711");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("pacs_work", "find-failed"));
  EXPECT_EQ(app.state("pacs_light"), "quiet");
  ASSERT_TRUE(app.wait_for_state("pacs_typing", "no"));
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("start", "cases"));
}

// Nothing leaves before it was listed, and before a key was held.
TEST_F(PacsWindow, SendsTheResultsOfTheOpenCase) {
  const Orthanc orthanc({.our_port = our_port_});
  write_peers(orthanc);
  cases::save_case(folder_ / "Knee.arthro",
                   phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), "Knee of a test"));
  const VirtualDisplay display(1280, 720);
  // By another way: it is the open one all the same.
  std::filesystem::create_directory_symlink(folder_ / "Knee.arthro", folder_ / "Way.arthro");
  RunningWorkstation app(display, folder_.path(), {(folder_ / "Way.arthro").string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F5");
  ASSERT_TRUE(app.wait_for_state("case_selected", "Knee of a test"));
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("pacs_light", "good"));
  app.press("r");
  ASSERT_TRUE(app.wait_for_state("pacs", "send"));
  ASSERT_TRUE(app.wait_for_state("pacs_sends", "the open case"));
  app.press("d");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("pacs_work", "write-done", 120) ||
              app.state("pacs_work") == "write-unreliable")
      << app.state("pacs_says");
  EXPECT_NE(app.state("pacs_outgoing"), "0");
  const auto stored = [&] {
    return pacs::find(orthanc.peer(), quick_connection(), {.study_date = "19000101-20991231"})
        .patients.size();
  };
  app.press("Return");  // a press is not enough
  EXPECT_EQ(stored(), 0U);
  ASSERT_TRUE(app.hold_until("Return", "pacs_work", "send-done", 120)) << app.state("pacs_says");
  EXPECT_EQ(app.state("pacs_commitment"), "confirmed");
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("pacs", "search"));
  EXPECT_FALSE(fs::exists(folder_ / "arthronaut/outgoing"));
}

// The case that is selected in the list is what is sent: where it is not the open one, that is said.
TEST_F(PacsWindow, SaysThatWhatWouldBeSentIsOfAnotherCase) {
  const Orthanc orthanc({.our_port = our_port_});
  write_peers(orthanc);
  const auto knee = phantom::make_phantom_knee({.edge_length_mm = 3});
  for (const char* name : {"First", "Second"})
    cases::save_case(folder_ / (std::string(name) + ".arthro"), phantom::case_of(knee, name));
  const VirtualDisplay display(1280, 720);
  {  // What was open once is in the list.
    RunningWorkstation before(display, folder_.path(), {(folder_ / "Second.arthro").string()});
    ASSERT_TRUE(before.wait_for_state("case", "open", 120));
  }
  RunningWorkstation app(display, folder_.path(), {(folder_ / "First.arthro").string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F5");
  ASSERT_TRUE(app.wait_for_state("case_selected", "First"));
  ASSERT_TRUE(app.wait_for_widget("start.case.1"));
  app.click("start.case.1");
  ASSERT_TRUE(app.wait_for_state("case_selected", "Second"));
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("pacs_light", "good"));
  app.press("r");
  ASSERT_TRUE(app.wait_for_state("pacs_sends", "another case"));
}

}  // namespace
}  // namespace arthronaut::test
