#include "app/navigate/navigate_setup.h"

#include <gtest/gtest.h>

#include "app/case/case_calibration.h"
#include "navigation/camera/camera_file.h"
#include "navigation/simulator/simulated_operation.h"
#include "planning/geometry/error.h"
#include "planning/phantom/phantom_case.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::navigate {
namespace {

// The simulation is tracked with the camera and the tools that Set up adopted of it, and with what is built
// in before that; the words on the screen say which.
TEST(NavigateSetup, TheSimulationIsTrackedWithWhatSetUpAdopted) {
  const test::TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  const open_case::PlanModel model(
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 2.5}), "test"));
  const auto setup = [&] {
    return simulated_setup(model, bones::BoneKind::Femur, folder, SimulatedPart::Scratch).setup;
  };
  const camera::Calibration built_in = simulator::standard_camera();
  EXPECT_EQ(setup().pipeline.calibration.focal_px, built_in.focal_px);
  EXPECT_EQ(setup().calibration, "camera built in; tools nominal");
  EXPECT_EQ(setup().pipeline.calibrated->scope_name, camera::kSimulatedScope);

  camera::CalibrationRecord record;
  record.calibration = built_in;
  record.calibration.focal_px += 1;
  record.scope_name = camera::kSimulatedScope;
  record.date_utc = "2026-11-21T10:00:00Z";
  camera::write_camera_file(cases::camera_file(folder), record);
  tools::ToolSet tools = tools::standard_tools();
  for (tools::Tool& tool : tools.tools)
    if (tool.name == "probe") tool.tip_mm->x() += 0.1;
  tools::write_tools_file(cases::tools_file(folder), tools);
  const operation::SourceSetup adopted = setup();
  EXPECT_EQ(adopted.pipeline.calibration.focal_px, built_in.focal_px + 1);
  EXPECT_EQ(adopted.pipeline.calibrated->date_utc, "2026-11-21T10:00:00Z");
  EXPECT_NEAR(adopted.pipeline.tools.find_tool("probe")->tip_mm->x(),
              tools::standard_tools().find_tool("probe")->tip_mm->x() + 0.1, 1e-9);
  EXPECT_TRUE(adopted.calibration.starts_with("camera simulated")) << adopted.calibration;
}

// Typed in the window, a tracker goes before the one of the tools, whose names and errors stay; without one
// it is what the tools say.
TEST(NavigateSetup, ATrackerThatWasTypedSeesTheToolsOfALiveSource) {
  const test::TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  const open_case::PlanModel model(
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 2.5}), "test"));
  camera::CalibrationRecord record;
  record.calibration = simulator::standard_camera();
  record.scope_name = "Scope 30";
  record.date_utc = "2026-11-21T10:00:00Z";
  camera::write_camera_file(cases::camera_file(folder), record);
  tools::ToolSet tools = tools::standard_tools();
  tools.tracker = tools::OutsideTracker{"igtl://tower", 0.2, 0.1, {{"probe", "Stylus"}}, true};
  tools::write_tools_file(cases::tools_file(folder), tools);
  const auto setup = [&](const std::string& tracker) {
    return camera_setup(model, bones::BoneKind::Femur, folder, {"scope", std::nullopt, "udp://@:5000"},
                        sources::DeviceTurns(), 1.33, tracker);
  };
  EXPECT_EQ(setup("").setup.pipeline.tools.tracker->address, "igtl://tower");
  EXPECT_EQ(setup("").setup.pipeline.calibrated->scope_name, "Scope 30");
  const theatre::TheatreSource typed = setup("igtl://cart:18945");
  EXPECT_EQ(typed.setup.pipeline.tools.tracker->address, "igtl://cart:18945");
  EXPECT_EQ(typed.setup.pipeline.tools.tracker->sigma_mm, 0.2);
  EXPECT_NE(typed.setup.calibration.find("igtl://cart:18945"), std::string::npos);
  EXPECT_TRUE(typed.tracker) << "somebody listens to it";
}

// A source knows whether it is measured by the simulator's camera, whatever the file's scope is called.
TEST(NavigateSetup, Hazard26AVideoKnowsThatItsCameraIsTheSimulators) {
  const test::TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  const open_case::PlanModel model(
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 2.5}), "test"));
  tools::write_tools_file(cases::tools_file(folder), tools::standard_tools());
  for (const auto origin : {provenance::Origin::Simulated, provenance::Origin::Measured}) {
    camera::CalibrationRecord record;
    record.calibration = simulator::standard_camera();
    record.scope_name = "Scope 30";
    record.provenance.origin = origin;
    camera::write_camera_file(cases::camera_file(folder), record);
    const bool is_simulated = origin == provenance::Origin::Simulated;
    EXPECT_EQ(has_real_scope(folder), !is_simulated);
    const auto setup = video_setup(model, bones::BoneKind::Femur, folder, folder / "clip.mkv", 1.33).setup;
    EXPECT_EQ(operation::has_camera_of_simulator(setup), is_simulated);
  }
}

// Before anything is calibrated: where that is done, and no names of files.
TEST(NavigateSetup, ACaseWithoutCameraOrToolsSaysWhereTheyAreMade) {
  const test::TemporaryFolder temporary;
  const open_case::PlanModel model(
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 2.5}), "test"));
  const auto refusal = [&] {
    return test::message_of<InvalidInput>([&] {
      (void)camera_setup(model, bones::BoneKind::Femur, temporary.path(),
                         {"scope", std::nullopt, "udp://@:5000"}, sources::DeviceTurns(), 1.33, "");
    });
  };
  EXPECT_EQ(refusal(), "no camera is calibrated for this case: do it in Set up (F4)");
  camera::CalibrationRecord record;
  record.calibration = simulator::standard_camera();
  camera::write_camera_file(cases::camera_file(temporary.path()), record);
  EXPECT_EQ(refusal(), "no tools are known in this case: make them known in Set up (F4)");
}

}  // namespace
}  // namespace arthronaut::navigate
