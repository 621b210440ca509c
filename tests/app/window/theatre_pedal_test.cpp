// The real window worked by feet: one pedal through the whole operation, another one back, a foot switch.
#include <gtest/gtest.h>
#include <linux/input.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include "tests/app/window/theatre.h"

namespace arthronaut::test {
namespace {

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

}  // namespace
}  // namespace arthronaut::test
