#include "app/case/case_calibration.h"

#include <gtest/gtest.h>

#include <fstream>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/doubted_camera_file.h"
#include "navigation/simulator/simulated_operation.h"
#include "planning/cases/case.h"
#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::open_case {
namespace {

constexpr bool kSimulated = true, kReal = false;

class CaseCalibration : public ::testing::Test {
 protected:
  void adopt_camera(const std::string& scope_name, double focal_px) const {
    camera::CalibrationRecord record;
    record.calibration = simulator::standard_camera();
    record.calibration.focal_px = focal_px;
    record.scope_name = scope_name;
    record.date_utc = "2026-11-21T10:00:00Z";
    camera::write_camera_file(cases::camera_file(folder_), record);
  }
  // The standard tools with a probe whose tip was found at another place.
  void adopt_tools(double tip_z_mm) const {
    tools::ToolSet tools = tools::standard_tools();
    for (tools::Tool& tool : tools.tools) {
      if (tool.name != "probe") continue;
      tool.tip_mm->z() = tip_z_mm;
      tool.residual_mm = 0.2;
      tool.provenance = {provenance::Origin::Measured, "2026-11-22T09:00:00Z"};
    }
    tools::write_tools_file(cases::tools_file(folder_), tools);
  }
  [[nodiscard]] std::string words() const {
    return calibration_in_words(kSimulated, folder_, "2026-11-22T10:00:00Z");
  }
  const test::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
};

// Without anything adopted the simulation is tracked with what is built in, and a real scope with nothing.
TEST_F(CaseCalibration, StartsWithWhatIsBuiltIn) {
  EXPECT_EQ(camera_of(kSimulated, folder_).focal_px, simulator::standard_camera().focal_px);
  EXPECT_EQ(words(), "camera built in; tools nominal");
  EXPECT_THROW((void)camera_of(kReal, folder_), InvalidInput);
  EXPECT_TRUE(camera_is_kept(kSimulated, folder_).empty());
  EXPECT_TRUE(tools_are_kept(kSimulated, folder_).empty());
}

// What was adopted of the simulated arthroscope is what its pictures are tracked with, and the words say so.
TEST_F(CaseCalibration, TheSimulationUsesWhatItsSetUpAdopted) {
  adopt_camera(std::string(camera::kSimulatedScope), 601);
  adopt_tools(77);
  EXPECT_EQ(camera_of(kSimulated, folder_).focal_px, 601);
  EXPECT_EQ(tools_of(kSimulated, folder_).find_tool("probe")->tip_mm->z(), 77);
  EXPECT_NE(words().find("camera simulated"), std::string::npos) << words();
  EXPECT_NE(words().find("; probe measured 2026-11-22; nominal: femoral guide, "), std::string::npos)
      << words();
  EXPECT_TRUE(camera_is_kept(kSimulated, folder_).empty());
}

// Before anything is guided by it the screen says what speaks against a calibration that was kept.
TEST_F(CaseCalibration, ADoubtedCameraIsSaidToBeNotReliable) {
  camera::CalibrationRecord record;
  record.calibration = simulator::standard_camera();
  record.scope_name = "Scope 30";
  record.date_utc = "2026-11-21T10:00:00Z";
  const auto file = cases::camera_file(folder_);
  camera::write_doubted_camera_file(file, record, {"the lens was not turned"});
  EXPECT_NE(calibration_in_words(kReal, folder_, "2026-11-22T10:00:00Z")
                .find("NOT RELIABLE: the lens was not turned"),
            std::string::npos);
  EXPECT_EQ(camera::read_camera_doubts(file), std::vector<std::string>{"the lens was not turned"});
  camera::write_camera_file(file, record);
  EXPECT_TRUE(camera::read_camera_doubts(file).empty());
  EXPECT_EQ(calibration_in_words(kReal, folder_, "2026-11-22T10:00:00Z").find("NOT RELIABLE"),
            std::string::npos);
}

// On the time-out's card ages stand for dates, and nothing else is left out: not the date in a doubt.
TEST_F(CaseCalibration, AgesTakeThePlaceOfTheDatesOfWhatWasMeasured) {
  camera::CalibrationRecord record;
  record.calibration = simulator::standard_camera();
  record.scope_name = "Scope 30";
  record.provenance = {provenance::Origin::Measured, "2026-11-18T10:00:00Z"};
  camera::write_doubted_camera_file(cases::camera_file(folder_), record, {"no board since 2026-11-18"});
  adopt_tools(77);
  const std::string words = calibration_in_words(kReal, folder_, "2026-11-22T10:00:00Z", Dates::AsAge);
  EXPECT_TRUE(
      words.starts_with("camera measured, 4 days old, NOT RELIABLE: no board since 2026-11-18; "
                        "probe measured today; not measured: "))
      << words;
  EXPECT_EQ(
      in_words({provenance::Origin::Measured, "2026-11-21T10:00:00Z"}, "2026-11-22T10:00:00Z", Dates::AsAge),
      "measured, 1 day old");
  EXPECT_EQ(
      in_words({provenance::Origin::Measured, "2026-11-23T10:00:00Z"}, "2026-11-22T10:00:00Z", Dates::AsAge),
      "measured, date lies ahead: is the clock right?");
  // Of which the same is to be said need no names there.
  tools::ToolSet all = tools::standard_tools();
  for (tools::Tool& tool : all.tools)
    tool.provenance = {provenance::Origin::Measured, "2026-11-22T08:00:00Z"};
  tools::write_tools_file(cases::tools_file(folder_), all);
  const std::string alike = calibration_in_words(kReal, folder_, "2026-11-22T10:00:00Z", Dates::AsAge);
  EXPECT_TRUE(alike.ends_with("; tools measured today")) << alike;
}

// A real scope's files are of no use to the simulation, which does not replace them either.
TEST_F(CaseCalibration, KeepsRealFilesFromTheSimulation) {
  adopt_camera("Scope 30", 601);
  adopt_tools(77);
  EXPECT_EQ(camera_of(kSimulated, folder_).focal_px, simulator::standard_camera().focal_px);
  EXPECT_NE(tools_of(kSimulated, folder_).find_tool("probe")->tip_mm->z(), 77);
  EXPECT_EQ(words(), "camera built in; tools nominal");
  EXPECT_EQ(camera_of(kReal, folder_).focal_px, 601);
  EXPECT_EQ(tools_of(kReal, folder_).find_tool("probe")->tip_mm->z(), 77);
  EXPECT_FALSE(camera_is_kept(kSimulated, folder_).empty());
  EXPECT_FALSE(tools_are_kept(kSimulated, folder_).empty());
  EXPECT_TRUE(camera_is_kept(kReal, folder_).empty());
}

// A case with a real scope takes no simulated tip, whether it has a tools.json or not.
TEST_F(CaseCalibration, Hazard26ASimulatedTipIsNotAdoptedIntoARealCase) {
  EXPECT_FALSE(has_real_camera(folder_));
  adopt_camera("Scope 30", 601);
  EXPECT_TRUE(has_real_camera(folder_));
  EXPECT_FALSE(tools_are_kept(kSimulated, folder_).empty());
  adopt_tools(77);
  EXPECT_FALSE(tools_are_kept(kSimulated, folder_).empty());
  EXPECT_TRUE(tools_are_kept(kReal, folder_).empty());
}

// What the simulator found is of no use to a live camera, and says so; of the tools the first one is named.
TEST_F(CaseCalibration, Hazard26LivePicturesAreNotMeasuredWithWhatIsSimulated) {
  EXPECT_TRUE(camera_is_not_for_live(folder_).empty());
  EXPECT_TRUE(tools_are_not_for_live(folder_).empty());
  adopt_camera(std::string(camera::kSimulatedScope), 601);
  EXPECT_NE(camera_is_not_for_live(folder_).find("simulated"), std::string::npos);
  adopt_camera("Scope 30", 601);
  EXPECT_TRUE(camera_is_not_for_live(folder_).empty());
  tools::ToolSet tools = tools::standard_tools();
  tools.tools.front().provenance = {provenance::Origin::Simulated, "2026-11-21T10:00:00Z"};
  tools::write_tools_file(cases::tools_file(folder_), tools);
  EXPECT_TRUE(tools_are_not_for_live(folder_).starts_with("probe: ")) << tools_are_not_for_live(folder_);
}

// Each number of the case says where it comes from and since when.
TEST_F(CaseCalibration, Hazard6SaysWhereCameraAndToolsComeFrom) {
  using provenance::Origin;
  EXPECT_EQ(provenance_of(kSimulated, folder_).camera.origin, Origin::Simulated);
  EXPECT_THROW((void)provenance_of(kReal, folder_), InvalidInput);
  adopt_camera("Scope 30", 601);
  tools::ToolSet tools = tools::standard_tools();
  tools.tools.front().provenance = {Origin::Measured, "2026-11-20T23:00:00Z"};
  tools::write_tools_file(cases::tools_file(folder_), tools);
  const CaseProvenance all = provenance_of(kReal, folder_);
  ASSERT_EQ(all.tools.size(), tools.tools.size());
  const std::string now = "2026-11-21T07:00:00Z";
  EXPECT_EQ(in_words(all.camera, now), "measured 2026-11-21");
  EXPECT_EQ(all.tools.front().name, "probe");
  EXPECT_EQ(in_words(all.tools.front().provenance, now), "measured 2026-11-20, 1 day old");
  EXPECT_EQ(in_words(all.tools.back().provenance, now), "nominal");
  EXPECT_EQ(in_words({Origin::Simulated, "2026-11-18T10:00:00Z"}, now), "simulated, 3 days old");
  EXPECT_EQ(in_words({Origin::Measured, ""}, now), "measured, date not known");
  EXPECT_EQ(in_words({Origin::Measured, "2026-12-01T10:00:00Z"}, now),
            "measured 2026-12-01, date lies ahead: is the clock right?");
}

// A broken camera.json stops the real scope with the file's name, and does not stop the simulation.
TEST_F(CaseCalibration, ABrokenFileIsTold) {
  std::ofstream(folder_ / "camera.json") << "x";
  EXPECT_GT(camera_of(kSimulated, folder_).focal_px, 0);
  EXPECT_FALSE(camera_is_kept(kSimulated, folder_).empty());
  EXPECT_THROW((void)camera_of(kReal, folder_), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::open_case
