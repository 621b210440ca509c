// An operation in the real window, worked from outside as a surgeon and bad luck do: sources that fail, a
// plan that is edited meanwhile, a folder that takes nothing, a program that is killed.
#include <gtest/gtest.h>
#include <linux/input.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>
#include <set>
#include <sstream>

#include "navigation/camera/camera_file.h"
#include "navigation/recording/video_encoder.h"
#include "navigation/simulator/simulated_operation.h"
#include "navigation/tools/tool_set.h"
#include "planning/cases/case.h"
#include "planning/phantom/phantom_case.h"
#include "tests/app/window/display.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

class Theatre : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
    cases::save_case(case_folder(), phantom::case_of(knee_, "Phantom"));
  }
  // Where the workstation looks for the built-in case.
  [[nodiscard]] std::filesystem::path case_folder() const {
    return folder_ / "arthronaut" / "Phantom.arthro";
  }
  // The case is of a real arthroscope from now on.
  void adopt_real_scope() const {
    camera::CalibrationRecord camera;
    camera.calibration = simulator::standard_camera();
    camera.scope_name = "Scope 30";
    camera::write_camera_file(cases::camera_file(case_folder()), camera);
    tools::write_tools_file(cases::tools_file(case_folder()), tools::standard_tools());
  }
  // The first pictures of the scripted surgeon, as a file that nobody can tell from a recording.
  void write_clip(int frame_count) const {
    simulator::SimulationOptions options;
    options.knee = knee_;
    options.camera = simulator::standard_camera();
    options.tools = tools::standard_tools();
    options.plan = knee_.femoral_tunnel;
    simulator::SimulatedOperation operation(options, simulator::Phase::Scratch);
    recording::VideoEncoder clip(case_folder() / "clip.mkv", 1920, 1080, 30);
    for (int i = 0; i < frame_count; ++i) clip.encode(*operation.next());
    clip.finish();
  }
  static void show_navigate(const RunningWorkstation& app) {
    ASSERT_TRUE(app.wait_for_state("case", "open", 120));
    app.press("F2");
    ASSERT_TRUE(app.wait_for_state("mode", "navigate"));
    ASSERT_TRUE(app.wait_for_widget("navigate.next"));
  }
  static void start_simulation(const RunningWorkstation& app) {
    show_navigate(app);
    app.press("s");
    ASSERT_TRUE(app.wait_for_state("picture", "live", 120));
  }
  [[nodiscard]] std::pair<int, std::string> replay(const std::string& session) const {
    return run_arthronaut("replay '" + case_folder().string() + "' --session " + session);
  }
  // How many there are is the machine's speed; all of them must be the same.
  void expect_same_states(const std::string& session) const {
    const auto [exit_code, output] = replay(session);
    EXPECT_EQ(exit_code, 0) << output;
    const std::string words = "states the same to the last bit: ";
    const std::size_t at = output.find(words);
    ASSERT_NE(at, std::string::npos) << output;
    long equal = 0, compared = 0;
    std::istringstream(output.substr(at + words.size())) >> equal;
    std::istringstream(output.substr(output.find(" of ", at) + 4)) >> compared;
    EXPECT_GT(compared, 0);
    EXPECT_EQ(equal, compared) << output;
  }
  const phantom::PhantomKnee knee_ = phantom::make_phantom_knee({});
  const TemporaryFolder folder_;
};

bool becomes(const std::function<bool()>& is_so, double seconds) {
  for (double waited_s = 0; waited_s < seconds; waited_s += 0.02) {
    if (is_so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return is_so();
}

// What was registered in a simulation guides nothing of a video: it is void, and the screen says why. Both
// sessions run again to the same states, the registration and its end with them.
TEST_F(Theatre, Hazard1ARegistrationOfASimulationIsVoidInAVideo) {
  adopt_real_scope();
  write_clip(90);
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  ASSERT_TRUE(app.wait_for_state("standing", "stands", 400));
  const std::string simulated = app.state("journal");
  ASSERT_TRUE(app.hold_until("o", "source_kind", "RECORDING"));
  EXPECT_TRUE(app.wait_for_state("standing", "void", 60));
  EXPECT_NE(app.state("guidance"), "valid");
  EXPECT_TRUE(
      becomes([&] { return app.state("detail").find("another kind of pictures") != std::string::npos; }, 60))
      << app.state("detail");
  EXPECT_EQ(app.state("guidance"), "Registration void");
  const std::string of_video = app.state("journal");
  EXPECT_NE(of_video, simulated);
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
  expect_same_states(simulated);
  expect_same_states(of_video);
}

// A source that fails starts no other kind, whatever ran before it and however often the pedal is pressed.
TEST_F(Theatre, Hazard2AfterASourceThatFailedThePedalStartsNoOtherKind) {
  adopt_real_scope();
  std::ofstream(case_folder() / "broken.mkv") << "no video at all";
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  show_navigate(app);
  // A real case offers no simulation unasked.
  EXPECT_TRUE(app.wait_for_state("next", "open the next video"));
  app.press("s");
  ASSERT_TRUE(app.wait_for_state("picture", "live", 120));
  EXPECT_EQ(app.state("source_kind"), "SIMULATION");
  ASSERT_TRUE(app.hold_until("o", "guidance", "Source failed", 60));
  ASSERT_TRUE(app.wait_for_state("source_kind", "RECORDING"));
  for (int press = 0; press < 3; ++press) {
    app.press("space");
    // Long enough for a simulation to have shown its first picture.
    EXPECT_FALSE(becomes([&] { return app.state("source_kind") != "RECORDING"; }, 2)) << press;
    EXPECT_TRUE(app.wait_for_state("guidance", "Source failed", 60));
    EXPECT_EQ(app.state("next").find("simula"), std::string::npos) << app.state("next");
  }
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(60), 0);
}

// A plan that is edited while the operation runs is offered, not taken: the one in force stays until the
// pedal takes the other one over.
TEST_F(Theatre, Hazard5AnEditedPlanWaitsUntilItIsTakenOver) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  EXPECT_TRUE(app.wait_for_state("plan", "in force"));
  app.press("F1");
  ASSERT_TRUE(app.wait_for_state("mode", "plan"));
  app.press("Right");
  ASSERT_TRUE(app.wait_for_state("undo", "Aim the femoral tunnel"));
  app.press("F2");
  ASSERT_TRUE(app.wait_for_state("mode", "navigate"));
  ASSERT_TRUE(app.wait_for_state("plan", "edited"));
  ASSERT_TRUE(app.wait_for_state("next", "the plan was edited: take it over"));
  EXPECT_EQ(app.state("picture"), "live");
  app.press("space");
  EXPECT_TRUE(app.wait_for_state("plan", "in force"));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// Two tunnels in the bone: nothing starts by the pedal before one is chosen; the other one is offered while a
// source runs, and guides once it is taken over.
TEST_F(Theatre, Hazard38OfTwoTunnelsOneIsChosenAndNamed) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("b");
  ASSERT_TRUE(app.wait_for_state("undo", "Plan two bundles in the femur"));
  app.press("F2");
  ASSERT_TRUE(app.wait_for_state("mode", "navigate"));
  ASSERT_TRUE(app.wait_for_state("next", "choose the tunnel of the femur that is drilled: AM (1) or PL (2)"));
  app.press("space");
  EXPECT_EQ(app.state("tunnel"), "none");
  EXPECT_EQ(app.state("picture"), "none");
  app.press("1");
  ASSERT_TRUE(app.wait_for_state("tunnel", "femur AM"));
  ASSERT_TRUE(app.wait_for_state("next", "start the simulated operation"));
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("picture", "live", 120));
  app.press("2");
  ASSERT_TRUE(app.wait_for_state("plan", "edited"));
  EXPECT_EQ(app.state("tunnel"), "femur AM");
  ASSERT_TRUE(app.wait_for_state("next", "take over the tunnel femur PL"));
  app.press("space");
  EXPECT_TRUE(app.wait_for_state("tunnel", "femur PL"));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

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
    ASSERT_TRUE(app.hold_until("Escape", "guidance", "The source has ended", 60));
    app.press("ctrl+q");
    ASSERT_EQ(app.wait_for_exit(120), 0);
  }
  expect_same_states(session);
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
    EXPECT_NE(output.find("never finished"), std::string::npos) << output;
  }
  EXPECT_LT(empty_count, kKills);
  RunningWorkstation app(display, folder_.path());
  EXPECT_TRUE(app.wait_for_state("case", "open", 120));
  EXPECT_TRUE(app.wait_for_state("access", "own"));
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
  {
    RunningWorkstation app(display, folder_.path());
    show_navigate(app);
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
    EXPECT_TRUE(app.wait_for_state("next", "touch the bone once: confirms the registration"));
    // The simulated surgeon's probe rests on the bone now and then.
    ASSERT_TRUE(becomes(
        [&] {
          app.press("t");
          return app.wait_for_state("standing", "stands", 0.3);
        },
        400));
    next = app.state("journal");
    std::this_thread::sleep_for(std::chrono::seconds(2));
    ASSERT_TRUE(app.hold_until("Escape", "guidance", "The source has ended", 60));
    app.press("ctrl+q");
    ASSERT_EQ(app.wait_for_exit(120), 0);
  }
  std::stringstream header;
  header << std::ifstream(case_folder() / "sessions" / next / "session.json").rdbuf();
  EXPECT_NE(header.str().find("\"continues\": \"" + left + "\""), std::string::npos) << header.str();
  const auto [exit_code, output] = replay(next);
  EXPECT_EQ(exit_code, 0) << output;
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
  show_navigate(app);
  ASSERT_TRUE(app.wait_for_state("resume", left, 60));
  app.press("Escape");
  EXPECT_TRUE(app.wait_for_state("resume", "none"));
  EXPECT_TRUE(app.wait_for_state("next", "start the simulated operation"));
  EXPECT_EQ(app.state("resumed"), "none");
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(60), 0);
}

// With nothing but the one pedal, pressed again and again by a foot that reads nothing: from the start to the
// tunnel in the femur and its marker out, on to the tibia, and to the end of the operation.
TEST_F(Theatre, OnePedalLeadsThroughTheWholeOperation) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  show_navigate(app);
  EXPECT_EQ(app.state("rail").size(), 9U);
  // Presses until the screen says it; what it led through on the way.
  const auto press_until = [&](const std::function<bool()>& is_there) {
    std::set<std::string> steps;
    EXPECT_TRUE(becomes(
        [&] {
          app.press("space");
          steps.insert(app.state("step"));
          std::this_thread::sleep_for(std::chrono::milliseconds(700));
          return is_there();
        },
        10))  // five hundred presses
        << app.state("next");
    return steps;
  };
  const auto expect_all_steps = [](const std::set<std::string>& steps) {
    for (const char* step : {"world marker", "digitise", "verify", "guide", "finish"})
      EXPECT_TRUE(steps.contains(step)) << step;
  };
  EXPECT_EQ(app.state("bone"), "femur");
  expect_all_steps(press_until([&] { return app.state("bone") == "tibia"; }));
  EXPECT_EQ(app.state("drilled"), "1");
  EXPECT_EQ(app.state("markers_out"), "1");
  EXPECT_EQ(app.state("finish"), "open") << "the tibia is to come";
  EXPECT_TRUE(app.wait_for_state("next", "start the simulated operation"));
  expect_all_steps(press_until([&] { return app.state("finish") == "done"; }));
  EXPECT_EQ(app.state("drilled"), "2");
  EXPECT_EQ(app.state("markers_out"), "2");
  // The pictures are ended by it too, where they did not end by themselves.
  (void)press_until([&] { return app.state("next").starts_with("done"); });
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// The way back: a second pedal goes step by step to what was done before, and the first one does it again;
// behind the first step it is the step of now once more.
TEST_F(Theatre, AnotherPedalGoesBackAndTheFirstOneRepeats) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  ASSERT_TRUE(app.wait_for_state("step", "digitise", 60));
  app.press("Prior");
  EXPECT_TRUE(app.wait_for_state("back_at", "tools"));
  EXPECT_TRUE(app.wait_for_state("next", "measure the tools again"));
  for (const char* step : {"world marker", "calibrate", "plan", ""}) {
    app.press("Prior");
    EXPECT_TRUE(app.wait_for_state("back_at", step));
  }
  app.press("Prior");
  EXPECT_TRUE(app.wait_for_state("back_at", "tools"));
  app.press("space");
  EXPECT_TRUE(app.wait_for_state("mode", "set up"));
  app.press("F2");
  EXPECT_TRUE(app.wait_for_state("back_at", ""));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// A foot switch that is named in the settings works the screen, from the moment in which it is there.
TEST_F(Theatre, AFootSwitchWorksTheScreen) {
  const std::filesystem::path device = folder_ / "event3", config = folder_ / "config";
  ASSERT_EQ(mkfifo(device.c_str(), 0600), 0);
  std::filesystem::create_directories(config / "arthronaut");
  std::ofstream(config / "arthronaut" / "theatre.json")
      << R"({"format": "arthronaut.theatre", "version": 1, "foot_switches": [")" << device.string()
      << R"("], "pedals": {"do_it": ["KEY_Z"], "overlay": ["KEY_X"]}})";
  setenv("XDG_CONFIG_HOME", config.c_str(), 1);
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  unsetenv("XDG_CONFIG_HOME");
  show_navigate(app);
  ASSERT_TRUE(app.wait_for_state("foot_switch", device.string()));
  std::ofstream pedals(device, std::ios::binary);
  const auto step_on = [&](int code) {
    for (const int value : {1, 0}) {
      input_event event{};
      event.type = EV_KEY;
      event.code = static_cast<__u16>(code);
      event.value = value;
      pedals.write(reinterpret_cast<const char*>(&event), sizeof event);
    }
    pedals.flush();
  };
  const std::string overlay = app.state("overlay");
  step_on(KEY_X);
  EXPECT_TRUE(becomes([&] { return app.state("overlay") != overlay; }, 40));
  EXPECT_EQ(app.state("picture"), "none");
  step_on(KEY_Z);
  EXPECT_TRUE(app.wait_for_state("picture", "live", 120));
  pedals.close();
  EXPECT_TRUE(app.wait_for_state("room", "", 40)) << "a pipe that nobody writes to is a device that waits";
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// A stream is named in the window: what is typed is no key of the screen, what is no address is told, and the
// kind of source is live, with all that it asks for. The next time it is offered.
TEST_F(Theatre, AStreamIsNamedInTheWindowAndIsLive) {
  adopt_real_scope();
  const VirtualDisplay display(1280, 720);
  {
    RunningWorkstation app(display, folder_.path());
    show_navigate(app);
    app.press("k");
    ASSERT_TRUE(app.wait_for_state("cameras", "address"));
    app.type("desk");
    app.press("Return");
    EXPECT_EQ(app.state("cameras"), "address");
    EXPECT_EQ(app.state("depth_stop"), "none") << "E is no key while it is typed";
    EXPECT_EQ(app.state("view"), "as it came");
    // The field takes two frames to be typed in again.
    const auto closes = [&] {
      app.press("Escape");
      return app.wait_for_state("cameras", "none", 2);
    };
    ASSERT_TRUE(becomes(closes, 20));
    app.press("k");
    ASSERT_TRUE(app.wait_for_state("cameras", "address"));
    app.type("gst:videotestsrc is-live=true ! video/x-raw,width=1920,height=1080,framerate=20/1 ! appsink");
    app.press("Return");
    ASSERT_TRUE(app.wait_for_state("time_out", "due", 60));
    EXPECT_EQ(app.state("source_kind"), "LIVE");
    EXPECT_EQ(app.state("next"), "time-out: confirm patient, side, plan and tools");
    app.press("space");
    EXPECT_TRUE(app.wait_for_state("time_out", "confirmed"));
    EXPECT_NE(app.state("guidance"), "valid");
    EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
  }
  RunningWorkstation app(display, folder_.path());
  show_navigate(app);
  if (app.state("resume") != "none") app.press("Escape");
  app.press("k");
  ASSERT_TRUE(becomes([&] { return app.state("cameras").starts_with("gst:videotestsrc"); }, 20));
  app.press("Escape");
  EXPECT_TRUE(app.wait_for_state("cameras", "none"));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// What the depth stop reads is typed, shown and kept; digits of it are no keys of the screen. A marker that
// was placed anew is one key, held.
TEST_F(Theatre, Hazard7TheDepthStopIsTypedAndTheMarkerPlacedAnewIsAKey) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path());
  start_simulation(app);
  app.press("e");
  ASSERT_TRUE(app.wait_for_widget("navigate.depth_field"));
  app.type("210");
  app.press("Return");
  EXPECT_FALSE(becomes([&] { return app.state("depth_stop") != "none"; }, 1)) << "no drill is so long";
  app.type("21.5");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("depth_stop", "21.5"));
  EXPECT_EQ(app.state("picture"), "live");
  app.press("n");
  EXPECT_TRUE(app.wait_for_state("hold", "Hold N to say that the marker was placed anew (let go)"));
  ASSERT_TRUE(becomes([&] { return !app.state("strokes").empty() && app.state("strokes") != "0"; }, 240));
  EXPECT_TRUE(app.hold_until("n", "strokes", "0", 60));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

}  // namespace
}  // namespace arthronaut::test
