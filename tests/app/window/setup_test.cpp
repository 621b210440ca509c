// Sets up a case in the real window by the pedal's key alone: the simulated arthroscope's board becomes
// camera.json, its swung probe tools.json.
#include <gtest/gtest.h>

#include <fstream>
#include <utility>

#include "navigation/camera/camera_file.h"
#include "navigation/simulator/simulated_operation.h"
#include "navigation/tools/tool_set.h"
#include "planning/files/atomic_file.h"
#include "tests/app/window/theatre.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

TEST(SettingUp, LeadsToAnAdoptedCameraAndTip) {
  if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
  const TemporaryFolder home;
  const std::filesystem::path folder = home / "arthronaut" / "Phantom.arthro";

  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, home.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F4");
  ASSERT_TRUE(app.wait_for_state("setup_next", "start Simulated arthroscope"));
  EXPECT_FALSE(std::filesystem::exists(folder / "camera.json"));

  // With a comma, as most of Europe writes it.
  for (const auto& [typed, is] : {std::pair{"1,75", "1.75"}, std::pair{"1,5", "1.50"}}) {
    app.click("setup.square");
    app.press("ctrl+a");
    app.type(typed);
    app.press("Return");
    ASSERT_TRUE(app.wait_for_state("setup_square_mm", is)) << app.state("setup_square_mm");
  }

  // Pictures that are good and held still are taken without a key.
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("setup_next", "calibrate", 180));
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("setup_verdict", "Fit for guidance", 120));
  ASSERT_TRUE(app.wait_for_widget("setup.residuals"));
  // With squares of another size the result is not of the board beside it.
  app.press("minus");
  ASSERT_TRUE(app.wait_for_state("setup_next", "calibrate")) << app.state("setup_next");
  app.press("equal space");
  ASSERT_TRUE(app.wait_for_state("setup_verdict", "Fit for guidance", 120));
  // A foot that bounces adopts nothing that nobody has read.
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("setup_next", "adopt the calibration"));
  EXPECT_FALSE(std::filesystem::exists(folder / "camera.json"));
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("setup_verdict", "Adopted"));
  const camera::CalibrationRecord camera = camera::read_camera_file(folder / "camera.json");
  const camera::Calibration truth = simulator::standard_camera();
  // What is asked of a calibration from three pictures: focal length within 0.3 %.
  EXPECT_NEAR(camera.calibration.focal_px, truth.focal_px, 0.003 * truth.focal_px);
  EXPECT_EQ(camera.scope_name, "Simulated arthroscope");
  EXPECT_TRUE(camera.calibration.covariance);
  EXPECT_EQ(camera.provenance.origin, provenance::Origin::Simulated);

  // The tip within a third of a millimetre of the built-in probe's.
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("setup_step", "tools"));
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("setup_verdict", "Fit for guidance", 240)) << app.state("setup_band");
  ASSERT_TRUE(app.wait_for_widget("setup.motion"));
  ASSERT_TRUE(app.wait_for_state("setup_next", "adopt the tip"));
  // Through another camera another tip would have been found.
  const std::string measured_through = files::read_text(folder / "camera.json");
  files::write_atomically(folder / "camera.json", measured_through + "\n");
  app.press("space");
  EXPECT_TRUE(becomes(
      [&] { return app.state("setup_adopted").starts_with("not saved: camera.json is another"); }, 20))
      << app.state("setup_adopted");
  EXPECT_FALSE(std::filesystem::exists(folder / "tools.json"));
  files::write_atomically(folder / "camera.json", measured_through);
  app.press("space");
  ASSERT_TRUE(app.wait_for_state("setup_verdict", "Adopted"));
  const tools::ToolSet adopted = tools::read_tools_file(folder / "tools.json");
  const tools::Tool* probe = adopted.find_tool("probe");
  ASSERT_NE(probe, nullptr);
  EXPECT_TRUE(probe->residual_mm.has_value());
  EXPECT_EQ(probe->provenance.origin, provenance::Origin::Simulated);
  EXPECT_LT((*probe->tip_mm - *tools::standard_tools().find_tool("probe")->tip_mm).norm(), 0.35);

  // A source still runs: leaving is to be held.
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);
}

// With a real scope in the case the tools step starts no simulator, and a path that leads nowhere is an
// error.
TEST(SettingUp, Hazard26ARealCaseNeverStartsTheSimulatorUnasked) {
  if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
  const TemporaryFolder home;
  const std::filesystem::path folder = home / "arthronaut" / "Phantom.arthro";

  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, home.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  camera::CalibrationRecord camera;
  camera.calibration = simulator::standard_camera();
  camera.scope_name = "Scope 30";
  camera::write_camera_file(folder / "camera.json", camera);
  app.press("F4");
  ASSERT_TRUE(app.wait_for_state("setup_step", "camera"));
  app.press("2");
  ASSERT_TRUE(app.wait_for_state("setup_step", "tools"));
  EXPECT_NE(app.state("setup_source"), "Simulated arthroscope");
  app.press("p");
  app.type((home / "nothing.mkv").string());
  app.press("Return");
  EXPECT_TRUE(app.wait_for_state("setup_source", "No source there: " + (home / "nothing.mkv").string()));
  app.press("space");
  EXPECT_TRUE(app.wait_for_state("setup_band", "no source"));
  EXPECT_FALSE(std::filesystem::exists(folder / "tools.json"));
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(60), 0);
}

// Keys that are shorter than a frame arrive in a text field, in their order, from the one on that opened it.
TEST(SettingUp, TakesATypedPathAtAnySpeed) {
  if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
  const TemporaryFolder home;
  std::filesystem::create_directories(home / "board");
  std::ofstream(home / "board" / "1.png") << "x";

  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, home.path());
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F4");
  ASSERT_TRUE(app.wait_for_state("setup_source", "Simulated arthroscope"));
  app.press("p");
  app.type((home / "boardxy").string());
  app.press("BackSpace BackSpace Return");
  EXPECT_TRUE(app.wait_for_state("setup_source", "Pictures in board")) << app.state("setup_source");
  // An address that gives no picture is none of those that are kept: five mistyped ones left no other.
  app.press("p");
  app.press("ctrl+a");
  app.type("rtsp://127.0.0.1:9/nothing");
  app.press("Return");
  EXPECT_TRUE(becomes([&] { return app.state("setup_source").starts_with("rtsp://127"); }, 20))
      << app.state("setup_source");
  app.press("space");
  EXPECT_TRUE(app.wait_for_state("setup_band", "Waiting for the first picture", 30))
      << app.state("setup_band") << "; " << app.state("setup_source") << "; " << app.state("setup_next");
  EXPECT_FALSE(std::filesystem::exists(home / "arthronaut" / "streams.json"));
  EXPECT_EQ(app.hold_to_exit("ctrl+q", 60), 0);  // it is still tried
}

}  // namespace
}  // namespace arthronaut::test
