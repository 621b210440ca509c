// digitise: from poses to the curve that the tip drew.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "navigation/strokes/poses_file.h"
#include "planning/files/atomic_file.h"
#include "tests/app/command_line/program.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// The probe's marker 20 mm before the tip, which draws 20 mm along the world's x axis in two seconds.
class DigitiseCommand : public ::testing::Test {
 protected:
  static constexpr int kFrames = 41;

  DigitiseCommand() {
    test::write_file(folder_ / "tools.json", R"({"format": "arthronaut.tools", "version": 1,
        "world_markers": [{"bone": "femur", "marker_id": 0, "size_mm": 4}],
        "tools": [{"name": "probe", "marker_id": 2, "size_mm": 4, "tip_mm": [0, 0, 20]}]})");
    std::vector<strokes::PoseRow> rows;
    for (int i = 0; i < kFrames; ++i) {
      strokes::PoseRow world, probe;
      world.frame = probe.frame = i;
      world.time_s = probe.time_s = 0.05 * i;
      probe.marker_id = 2;
      world.camera_from_marker.translation_mm = {1, 2, 30};
      probe.camera_from_marker.translation_mm = {1 + 0.5 * i, 2, 15};
      rows.push_back(world);
      rows.push_back(probe);
    }
    strokes::write_poses_file(folder_ / "poses.csv", rows);
  }
  [[nodiscard]] test::ProgramResult digitise(const std::string& tool, const std::string& output) const {
    return run_program({"digitise", "--poses", folder_ / "poses.csv", "--tools", folder_ / "tools.json",
                        "--bone", "femur", "--tool", tool, "-o", output});
  }

  const test::TemporaryFolder folder_;
};

TEST_F(DigitiseCommand, WritesWhereTheTipWasInTheWorldMarkersFrame) {
  const auto result = digitise("probe", folder_ / "curves.csv");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("points on 1 stroke, 20 mm"));
  const std::string table = files::read_text(folder_ / "curves.csv");
  EXPECT_THAT(table, StartsWith("curve,time_s,x_mm,y_mm,z_mm\n0,0.000000,0.000000,0.000000,5.000000\n"));
  EXPECT_THAT(table, HasSubstr("\n0,2.000000,20.000000,0.000000,5.000000\n"));
  const auto piped = digitise("probe", "-");
  EXPECT_EQ(piped.output, table) << "and nothing else";
}

// A table without a row is written, with exit code 4: the tool was never seen. One that is not declared is
// named with the file that lacks it.
TEST_F(DigitiseCommand, SaysWhatItHasNoCurveOf) {
  test::write_file(folder_ / "poses.csv",
                   "frame,time_s,marker_id,qw,qx,qy,qz,tx_mm,ty_mm,tz_mm,rms_px,mark_angle_deg\n"
                   "0,0,0,1,0,0,0,0,0,30,0.1,\n");
  const auto none = digitise("probe", "-");
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_EQ(none.output, "curve,time_s,x_mm,y_mm,z_mm\n");
  EXPECT_THAT(none.errors, HasSubstr("were never seen together over a stroke"));
  const auto unknown = digitise("needle", folder_ / "curves.csv");
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_THAT(unknown.errors, HasSubstr("tools.json: the tools declare no tool named \"needle\""));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "curves.csv"));
}

}  // namespace
}  // namespace arthronaut
