// What an operation in the real window leaves behind: a folder that takes nothing, a program that is killed,
// and what was left taken up again.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>

#include "app/case/plan_model.h"
#include "navigation/operation/operation.h"
#include "navigation/recording/drilled_before.h"
#include "navigation/recording/operation_record.h"
#include "navigation/recording/recording_lock.h"
#include "navigation/recording/session.h"
#include "tests/app/window/theatre.h"
#include "tests/resources/described.h"

namespace arthronaut::test {
namespace {

// A session of the window, with strokes, an excluded one and touches, runs again to the same states.
TEST_F(Theatre, Hazard12ASessionOfTheWindowReplaysToTheLastBit) {
  std::string session;
  {
    const VirtualDisplay display(1280, 720);
    RunningWorkstation app(display, folder_.path());
    start_simulation(app);
    ASSERT_TRUE(becomes([&] { return !app.state("strokes").empty() && app.state("strokes") != "0"; }, 240));
    app.press("x");
    app.press("t");
    app.press("p");
    session = app.state("journal");
    std::this_thread::sleep_for(std::chrono::seconds(3));  // some frames more, with what the keys asked for
    ASSERT_TRUE(app.hold_until("Escape", "guidance", "The pictures have ended", 60));
    app.press("ctrl+q");
    ASSERT_EQ(app.wait_for_exit(120), 0);
  }
  expect_same_states(session);
}

// How pictures are kept is chosen in the menu, is so from the next source on, and is remembered.
TEST_F(Theatre, KeepsPicturesAsWasChosenAndRemembersIt) {
  const VirtualDisplay display(1280, 720);
  std::string session;
  {
    RunningWorkstation app(display, folder_.path());
    show_navigate(app);
    EXPECT_TRUE(app.wait_for_state("pictures", "as-they-came"));
    app.press("Return");
    app.press("shift+Return");
    ASSERT_TRUE(app.wait_for_widget("navigate.pictures_h264"));
    app.click("navigate.pictures_h264");
    ASSERT_TRUE(app.wait_for_state("pictures", "h264"));
    app.press("Return");
    app.press("s");
    ASSERT_TRUE(app.wait_for_state("picture", "live", 120));
    app.press("ctrl+r");
    ASSERT_TRUE(app.wait_for_state("recording", "on", 60));
    session = app.state("journal");
    app.press("ctrl+2");  // the one that runs stays as it was begun
    ASSERT_TRUE(app.wait_for_state("pictures", "lossless"));
    std::this_thread::sleep_for(std::chrono::seconds(2));
    ASSERT_TRUE(app.hold_until("Escape", "guidance", "The pictures have ended", 60));
    app.press("ctrl+q");
    ASSERT_EQ(app.wait_for_exit(120), 0);
  }
  const recording::RecordedSession recorded(case_folder() / "sessions" / session);
  ASSERT_EQ(recorded.header().video_parts.size(), 1U);
  EXPECT_EQ(recorded.header().video_parts[0].as, recording::PicturesAs::H264);
  RunningWorkstation app(display, folder_.path());
  show_navigate(app);
  EXPECT_TRUE(app.wait_for_state("pictures", "lossless"));
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(60), 0);
}

// Nothing can be written where sessions belong: the operation goes on, and the screen says why it is not
// recorded.
TEST_F(Theatre, Hazard13ARecordThatCannotStartNeverTouchesGuidance) {
  std::ofstream(case_folder() / "sessions") << "a file where the folder belongs";
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  EXPECT_TRUE(becomes([&] { return app.state("journal").find("sessions") != std::string::npos; }, 60))
      << app.state("journal");
  // Asking for the video too changes nothing of it.
  app.press("ctrl+r");
  EXPECT_FALSE(becomes([&] { return app.state("recording") == "on"; }, 1));
  app.press("d");  // the probe draws no more: commands are still carried out
  EXPECT_TRUE(app.wait_for_state("picture", "live", 60));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// Killed at any moment, the case opens again, and what was recorded by then can be read and run again.
TEST_F(Theatre, Hazard12AKilledWindowLeavesASessionThatCanBeRead) {
  const VirtualDisplay display(1280, 720);
  std::mt19937 random(12);
  constexpr int kKills = 8;
  int empty_count = 0;
  for (int kill = 0; kill < kKills; ++kill) {
    RunningWorkstation app(display, folder_.path());
    start_simulation(app);
    ASSERT_TRUE(becomes([&] { return !app.state("journal").empty(); }, 60));
    const std::string session = app.state("journal");
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 3000));
    app.kill();
    const auto [exit_code, output] = replay(session);
    // Killed within the second after the first frame, nothing was committed yet: then that is what is said.
    const bool is_empty = output.find(": 0 of 0 frames replayed") != std::string::npos;
    EXPECT_EQ(exit_code, is_empty ? 4 : 0) << "kill " << kill << ": " << output;
    empty_count += is_empty ? 1 : 0;
    EXPECT_NE(output.find("session " + session), std::string::npos) << output;
    EXPECT_NE(output.find("the program ended before the session did"), std::string::npos) << output;
  }
  EXPECT_LT(empty_count, kKills);
  RunningWorkstation app(display, folder_.path());
  EXPECT_TRUE(app.wait_for_state("case", "open", 120));
  EXPECT_TRUE(app.wait_for_state("access", "own"));
  // In the words of whoever works with the case, and no warning.
  EXPECT_TRUE(app.wait_for_state("status", "Not closed the last time: all that was saved is here"));
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(60), 0);
}

// Killed in the middle of an operation, the case offers in Navigate what was left: one key brings it back,
// and it guides nothing until one touch on the bone. The session that follows says what it goes on from, and
// runs again to the same states.
TEST_F(Theatre, Hazard12AKilledOperationIsResumedAndGuidesAfterOneTouch) {
  const VirtualDisplay display(1280, 720);
  std::string left, next;
  {
    RunningWorkstation app(display, folder_.path());
    start_simulation(app);
    ASSERT_TRUE(app.wait_for_state("standing", "stands", 400));
    left = app.state("journal");
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));  // that it stands is committed by then
    app.kill();
  }
  const auto [told_with, told] = run_arthronaut("resume '" + case_folder().string() + "' --json");
  EXPECT_EQ(told_with, 0) << told;
  const nlohmann::json resumable = nlohmann::json::parse(told);
  EXPECT_EQ(test::undescribed(resumable, "resumable"), "");
  EXPECT_EQ(resumable.at("session"), left);
  {
    RunningWorkstation app(display, folder_.path());
    ASSERT_TRUE(app.wait_for_state("case", "open", 120));
    ASSERT_TRUE(app.wait_for_state("mode", "navigate", 60)) << "it is offered, whatever mode it opened in";
    ASSERT_TRUE(app.wait_for_state("resume", left, 60));
    ASSERT_TRUE(app.wait_for_widget("navigate.resume"));
    EXPECT_TRUE(app.wait_for_state("next", "resume the operation that was left"));
    EXPECT_EQ(app.state("standing"), "none") << "nothing is brought back unasked";
    app.press("space");
    ASSERT_TRUE(app.wait_for_state("resumed", left));
    EXPECT_TRUE(app.wait_for_state("resume", "none"));
    EXPECT_TRUE(app.wait_for_state("standing", "void"));
    app.press("space");
    ASSERT_TRUE(app.wait_for_state("picture", "live", 120));
    EXPECT_EQ(app.state("source_kind"), "SIMULATION");
    EXPECT_EQ(app.state("standing"), "void");
    EXPECT_TRUE(becomes(
        [&] { return app.state("next").starts_with("touch the bone once: confirms the registration"); }, 20))
        << app.state("next");
    // The simulated surgeon's probe rests on the bone now and then.
    ASSERT_TRUE(becomes(
        [&] {
          app.press("t");
          return app.wait_for_state("standing", "stands", 0.3);
        },
        400));
    next = app.state("journal");
    std::this_thread::sleep_for(std::chrono::seconds(2));
    ASSERT_TRUE(app.hold_until("Escape", "guidance", "The pictures have ended", 60));
    app.press("ctrl+q");
    ASSERT_EQ(app.wait_for_exit(120), 0);
  }
  std::stringstream header;
  header << std::ifstream(case_folder() / "sessions" / next / "session.json").rdbuf();
  EXPECT_NE(header.str().find("\"continues\": \"" + left + "\""), std::string::npos) << header.str();
  const auto [exit_code, output] = replay(next);
  EXPECT_EQ(exit_code, 0) << output;
}

// The dying program still holds the case and its record while the next one opens: they are this one's as soon
// as it lets go, and what was left comes to the front then.
TEST_F(Theatre, Hazard12AnOperationThatIsHeldByADyingProgramIsOfferedOnceItLetsGo) {
  const VirtualDisplay display(1280, 720);
  std::string left;
  {
    RunningWorkstation app(display, folder_.path());
    start_simulation(app);
    ASSERT_TRUE(becomes([&] { return !app.state("strokes").empty() && app.state("strokes") != "0"; }, 240));
    left = app.state("journal");
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));  // the strokes are committed by then
    app.kill();
  }
  // As the kernel has it until the memory of the one that was killed is gone.
  std::optional<recording::RecordingLock> case_held(case_folder()),
      record_held(case_folder() / "sessions" / left);
  RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  EXPECT_NE(app.state("access"), "own");
  std::this_thread::sleep_for(std::chrono::seconds(4));  // longer than anybody waits for it
  EXPECT_NE(app.state("mode"), "navigate");
  case_held.reset();
  ASSERT_TRUE(app.wait_for_state("access", "own", 120));
  record_held.reset();
  EXPECT_TRUE(app.wait_for_state("mode", "navigate", 120));
  EXPECT_TRUE(app.wait_for_state("resume", left, 60));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// Closed or killed between the bones, the case knows which tunnel is drilled and whose marker is out: the
// pedal goes on with what is left to be done, and never offers the same tunnel again.
TEST_F(Theatre, Hazard12AfterARestartBetweenTheBonesThePedalGoesOnWithTheOtherOne) {
  const std::string surface = [&] {  // said to be drilled, and killed before the marker was out
    const open_case::PlanModel model(cases::load_case(case_folder()));
    operation::OperationSetup setup;
    setup.mesh_sha256 = model.mesh_sha256(setup.bone);
    setup.plan = {*model.tunnel(setup.bone), model.drawn_length_mm(setup.bone)};
    operation::SourceSetup source;
    source.kind = sources::SourceKind::Live;
    source.pipeline.calibration = simulator::standard_camera();
    source.pipeline.tools = tools::standard_tools();
    operation::Operation femur(setup);
    femur.start_source(source);
    femur.apply(operation::TunnelDrilled{});
    recording::OperationRecord record(cases::create_session_folder(case_folder()), setup, source, {}, "");
    record.add(femur.take_journal());
    record.finish({});
    return setup.mesh_sha256;
  }();
  const VirtualDisplay display(1280, 720);
  {
    RunningWorkstation app(display, folder_.path());
    show_navigate(app);
    ASSERT_TRUE(app.wait_for_state("next", "take the femur's marker out, then press", 60));
    EXPECT_EQ(app.state("drilled"), "1");
    std::this_thread::sleep_for(std::chrono::seconds(2));  // as long as it takes to read it
    app.press("space");
    ASSERT_TRUE(app.wait_for_state("next", "go on to the tibia"));
    ASSERT_TRUE(becomes(
        [&] {
          return recording::drilled_before(case_folder(), {{bones::BoneKind::Femur, surface}})
              .tunnels.marker_is_out(bones::BoneKind::Femur);
        },
        60));
    app.kill();
  }
  RunningWorkstation app(display, folder_.path());
  show_navigate(app);
  ASSERT_TRUE(app.wait_for_state("next", "go on to the tibia", 60));
  EXPECT_EQ(app.state("markers_out"), "1");
  std::this_thread::sleep_for(std::chrono::seconds(2));
  app.press("space");
  EXPECT_TRUE(app.wait_for_state("bone", "tibia"));
  EXPECT_TRUE(app.wait_for_state("finish", "open"));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// Declined, the operation begins afresh, and nothing of the old one is there.
TEST_F(Theatre, Hazard12WhatWasLeftCanBeDeclined) {
  const VirtualDisplay display(1280, 720);
  std::string left;
  {
    RunningWorkstation app(display, folder_.path());
    start_simulation(app);
    ASSERT_TRUE(becomes([&] { return !app.state("strokes").empty() && app.state("strokes") != "0"; }, 240));
    left = app.state("journal");
    // A window that is closed in the middle of an operation leaves it too.
    EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
  }
  RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  EXPECT_FALSE(app.wait_for_state("mode", "navigate", 3)) << "that was no crash";
  show_navigate(app);
  ASSERT_TRUE(app.wait_for_state("resume", left, 60));
  app.press("Prior");  // by pedal alone
  EXPECT_TRUE(app.wait_for_state("resume", "none"));
  EXPECT_TRUE(app.wait_for_state("next", "start the simulated operation"));
  EXPECT_EQ(app.state("resumed"), "none");
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(60), 0);

  // It stays declined when the case is opened again, until somebody takes it up in Review.
  RunningWorkstation again(display, folder_.path());
  ASSERT_TRUE(again.wait_for_state("case", "open", 120));
  show_navigate(again);
  EXPECT_TRUE(again.wait_for_state("next", "start the simulated operation", 60));
  EXPECT_EQ(again.state("resume"), "none");
  again.press("F3");
  ASSERT_TRUE(again.wait_for_state("session", left));
  ASSERT_TRUE(again.wait_for_widget("review.resume"));
  again.press("g");
  EXPECT_TRUE(again.wait_for_state("mode", "navigate"));
  EXPECT_TRUE(again.wait_for_state("resume", left));
  again.press("space");
  EXPECT_TRUE(again.wait_for_state("resumed", left));
  again.press("ctrl+q");
  EXPECT_EQ(again.wait_for_exit(60), 0);
}

}  // namespace
}  // namespace arthronaut::test
