// What the tests of an operation in the real window share: a case of the built-in knee, and what is done to
// it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <sstream>
#include <thread>

#include "navigation/camera/camera_file.h"
#include "navigation/recording/video_encoder.h"
#include "navigation/simulator/simulated_operation.h"
#include "navigation/tools/tool_set.h"
#include "planning/cases/case.h"
#include "planning/phantom/phantom_case.h"
#include "tests/app/window/built_in_case.h"
#include "tests/app/window/display.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {

class Theatre : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
    put_built_in_case(case_folder());
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
    options.knee = phantom::knee_of(cases::load_case(case_folder()));
    options.camera = simulator::standard_camera();
    options.tools = tools::standard_tools();
    options.plan = options.knee.femoral_tunnel;
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
  const TemporaryFolder folder_;
};

inline bool becomes(const std::function<bool()>& is_so, double seconds) {
  for (double waited_s = 0; waited_s < seconds; waited_s += 0.02) {
    if (is_so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return is_so();
}

}  // namespace arthronaut::test
