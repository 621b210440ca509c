// An exercise from the list to its score, by the keys of a hand, on the real window.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/app/window/built_in_case.h"
#include "tests/app/window/display.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

namespace fs = std::filesystem;

class WorkstationTraining : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
    put_built_in_case(folder_ / "arthronaut" / "Phantom.arthro");
  }
  // The list of exercises, with the case's bones ready.
  static void open_list(RunningWorkstation& app) {
    ASSERT_TRUE(app.wait_for_state("case", "open", 120));
    app.press("F6");
    ASSERT_TRUE(app.wait_for_state("train_page", "list"));
    ASSERT_TRUE(app.wait_for_state("train_refusal", ""));
  }
  // The one of that name below the user's data.
  [[nodiscard]] fs::path found(const std::string& name) const {
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
      if (entry.path().filename() == name) return entry.path();
    return {};
  }
  const TemporaryFolder folder_;
};

// Aim: the list, the exercise on the theatre's screen as a simulation, the guide moved by a key that is held,
// "done", the score with all its parts; kept for the next time, and recorded as a session of the case.
TEST_F(WorkstationTraining, AnExerciseIsDoneByHandAndScored) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  ASSERT_NO_FATAL_FAILURE(open_list(app));
  EXPECT_TRUE(app.wait_for_state("train_runs", "0"));
  for (int i = 0; i < 3; ++i) app.press("Down");  // calibrate, pivot, register, aim
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("train_page", "running"));
  ASSERT_TRUE(app.wait_for_state("train_hand", "guide", 120));
  EXPECT_TRUE(app.wait_for_state("source_kind", "SIMULATION"));
  EXPECT_TRUE(app.wait_for_state("next", "follow the bullseye; on the plan: Enter, done", 60));
  EXPECT_EQ(app.state("pedal"), "waits");
  EXPECT_TRUE(app.wait_for_state("train_moved", "no"));
  EXPECT_TRUE(app.hold_until("d", "train_moved", "yes"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("train_page", "score", 60));
  EXPECT_EQ(app.state("train_done"), "yes");
  EXPECT_EQ(app.state("source_kind"), "none");

  const fs::path kept = found("training.json");
  ASSERT_FALSE(kept.empty());
  std::ifstream in(kept);
  const nlohmann::json scores = nlohmann::json::parse(in).at("scores");
  ASSERT_EQ(scores.size(), 1u);
  EXPECT_EQ(scores[0].at("exercise"), "aim");
  EXPECT_EQ(scores[0].at("trainee"), "by hand");
  EXPECT_EQ(scores[0].at("parts").size(), 6u);
  EXPECT_FALSE(found(scores[0].at("session").get<std::string>()).empty()) << scores[0].at("session");

  // Nothing is offered in Review that would be refused: an exercise has no report.
  app.press("F3");
  ASSERT_TRUE(app.wait_for_state("session", scores[0].at("session").get<std::string>(), 60));
  app.press("r");
  EXPECT_TRUE(app.wait_for_state("untaken_key",
                                 "R did nothing: Report is not possible now: an exercise is no operation on "
                                 "anybody; its score stands on the right"));
  app.press("F6");

  // Back in the list it is one run; Navigate knows nothing of it.
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("train_page", "list"));
  EXPECT_TRUE(app.wait_for_state("train_runs", "1"));
  app.press("F2");
  ASSERT_TRUE(app.wait_for_state("mode", "navigate"));
  EXPECT_TRUE(app.wait_for_state("source_kind", "none"));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// Calibrate: the board is moved by a key that is held until a picture of it is good, which is taken; "done"
// with one picture finds no camera, and says so. No session of it is kept.
TEST_F(WorkstationTraining, ACalibrationIsDoneByHandAndScored) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  ASSERT_NO_FATAL_FAILURE(open_list(app));
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("train_hand", "board", 60));
  EXPECT_EQ(app.state("source_kind"), "SIMULATION");
  (void)app.hold_until("q", "train_taken", "1", 1);  // nearer, for a second
  // One that is asked for while the board still swings is refused.
  bool is_taken = false;
  for (int tries = 0; tries < 10 && !is_taken; ++tries) {
    app.press("space");
    is_taken = app.wait_for_state("train_taken", "1", 4);
  }
  ASSERT_TRUE(is_taken) << app.state("train_refused");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("train_page", "score", 60));
  EXPECT_EQ(app.state("train_done"), "yes");
  std::ifstream in(found("training.json"));
  const nlohmann::json score = nlohmann::json::parse(in).at("scores").at(0);
  EXPECT_EQ(score.at("exercise"), "calibrate");
  EXPECT_EQ(score.at("session"), "");
  EXPECT_EQ(score.at("parts").at(0).at("points"), 0);
  EXPECT_TRUE(found("sessions").empty() || fs::is_empty(found("sessions")));
}

// Hazard 40: while an exercise has the theatre, Navigate starts nothing over it; stopped there, it is over.
TEST_F(WorkstationTraining, Hazard40NavigateStartsNothingWhileItIsLent) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  ASSERT_NO_FATAL_FAILURE(open_list(app));
  for (int i = 0; i < 3; ++i) app.press("Down");
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("train_hand", "guide", 120));
  app.press("F2");
  ASSERT_TRUE(app.wait_for_state("mode", "navigate"));
  const std::string refusal = "An exercise runs here: end it in Train (F6) first";
  ASSERT_TRUE(app.hold_until("k", "notice", refusal));
  EXPECT_EQ(app.state("header_notice"), refusal);
  const std::map<std::string, Area> shown = app.widgets();
  ASSERT_TRUE(shown.contains("app.notice")) << "research software, beside whatever is to be said";
  const auto right_of = [&](const char* name) { return shown.at(name).x + shown.at(name).width; };
  EXPECT_GE(shown.at("app.notice").x, right_of("app.side")) << "and not over whose knee it is";
  EXPECT_GE(shown.at("app.notice").x, right_of("app.whose"));
  EXPECT_EQ(app.state("cameras"), "none");
  EXPECT_EQ(app.state("source_kind"), "SIMULATION");
  ASSERT_TRUE(app.hold_until("Escape", "source_kind", "none", 60));
  app.press("F6");
  ASSERT_TRUE(app.wait_for_state("train_page", "score", 60));
  EXPECT_EQ(app.state("train_done"), "no");
}

// While the list of keys covers it, an exercise waits, and its clock with it.
TEST_F(WorkstationTraining, TheListOfKeysHoldsAnExerciseUp) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  ASSERT_NO_FATAL_FAILURE(open_list(app));
  for (int i = 0; i < 3; ++i) app.press("Down");
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("train_hand", "guide", 120));
  const auto time_s = [&] { return std::stod("0" + app.state("train_time")); };
  app.press("F10");
  ASSERT_TRUE(app.wait_for_state("key_list", "shown"));
  std::this_thread::sleep_for(std::chrono::seconds(1));  // the picture that was being drawn
  const double covered_s = time_s();
  std::this_thread::sleep_for(std::chrono::seconds(4));
  EXPECT_EQ(time_s(), covered_s);
  app.press("F10");
  ASSERT_TRUE(app.wait_for_state("key_list", "none"));
  for (int i = 0; i < 100 && time_s() <= covered_s; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_GT(time_s(), covered_s);
  EXPECT_LT(time_s(), covered_s + 3) << "what was covered counts nothing";
  // And it can be ended under the list.
  app.press("F10");
  ASSERT_TRUE(app.wait_for_state("key_list", "shown"));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// Esc must be held, and what is not done counts nothing.
TEST_F(WorkstationTraining, WhatIsStoppedCountsNothing) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  ASSERT_NO_FATAL_FAILURE(open_list(app));
  for (int i = 0; i < 3; ++i) app.press("Down");
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("train_hand", "guide", 120));
  app.press("Escape");
  EXPECT_TRUE(app.wait_for_state("hold", "Hold Esc to stop the exercise (let go)"));
  EXPECT_EQ(app.state("train_page"), "running");
  ASSERT_TRUE(app.hold_until("Escape", "train_page", "score", 60));
  EXPECT_EQ(app.state("train_done"), "no");
  EXPECT_EQ(app.state("train_runs"), "0") << "it is no run with no points";
}

}  // namespace
}  // namespace arthronaut::test
