// pivot on poses of a tool whose tip and axis are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "navigation/strokes/poses_file.h"
#include "navigation/tools/tool_set.h"
#include "planning/files/atomic_file.h"
#include "tests/app/command_line/marker_clip.h"
#include "tests/app/command_line/program.h"
#include "tests/resources/described.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using geometry::RigidTransform;
using test::run_program;
using ::testing::HasSubstr;

RigidTransform turned_by(const Eigen::Vector3d& axis, double deg) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(geometry::rad_from_deg(deg), axis.normalized())),
          Eigen::Vector3d::Zero()};
}

class PivotCommand : public ::testing::Test {
 protected:
  PivotCommand() {
    test::write_file(folder_ / "camera.json", test::clip_camera_json());
    tools::write_tools_file(folder_ / "tools.json", tools::standard_tools());
  }
  // Marker 0 lies still in the world; the tool turns as it is told, about a point of its own that rests.
  void write_poses(int marker_id, const Eigen::Vector3d& resting_in_tool_mm,
                   const std::function<RigidTransform(int)>& turn) const {
    const RigidTransform camera_from_world{Eigen::Quaterniond(0, 1, 0, 0), {1, 1, 24}};
    const Eigen::Vector3d resting_in_world_mm(6, -4, 2);
    std::vector<strokes::PoseRow> rows;
    for (int i = 0; i < 240; ++i) {
      RigidTransform world_from_tool = turn(i);
      world_from_tool.translation_mm = resting_in_world_mm - world_from_tool.rotate(resting_in_tool_mm);
      rows.push_back({i, i / 30.0, 0, camera_from_world, 0.1, {}, 4.0});
      rows.push_back({i, i / 30.0, marker_id, camera_from_world * world_from_tool, 0.1, {}, 4.0});
    }
    strokes::write_poses_file(folder_ / "poses.csv", rows);
  }
  void write_swing(double cone_deg) const {
    write_poses(2, tip_mm_, [cone_deg](int i) {
      return turned_by({1, 0, 0}, cone_deg * std::sin(0.057 * i)) *
             turned_by({0, 0, 1}, cone_deg * std::cos(0.037 * i));
    });
  }
  [[nodiscard]] test::ProgramResult pivot(int marker_id, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"pivot",
                                       "--marker",
                                       std::to_string(marker_id),
                                       "--poses",
                                       folder_ / "poses.csv",
                                       "--camera",
                                       folder_ / "camera.json",
                                       "--tools",
                                       folder_ / "tools.json",
                                       "--write-tools",
                                       folder_ / "tools.json",
                                       "-o",
                                       folder_ / "found.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  [[nodiscard]] tools::Tool tool(const char* name) const {
    return *tools::read_tools_file(folder_ / "tools.json").find_tool(name);
  }
  // What the camera of the poses says of itself.
  void set_in_camera(const char* key, const nlohmann::json& value) const {
    auto camera = nlohmann::json::parse(test::clip_camera_json());
    camera[key] = value;
    test::write_file(folder_ / "camera.json", camera.dump());
  }

  const Eigen::Vector3d tip_mm_{1, -33, -5};  // not where the drawing has it
  const test::TemporaryFolder folder_;
};

// The tip that tracking reads is the one that was found, with where it comes from; everything else of the
// file is as it was.
TEST_F(PivotCommand, TakesTheTipIntoTheTools) {
  write_swing(28);
  const auto result = pivot(2);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("the tip of the probe: in "));
  const tools::Tool probe = tool("probe");
  EXPECT_LT((*probe.tip_mm - tip_mm_).norm(), 1e-3);  // the digits of poses.csv
  EXPECT_TRUE(probe.tip_covariance_mm2 && probe.residual_mm);
  EXPECT_EQ(probe.provenance.origin, provenance::Origin::Measured);
  EXPECT_FALSE(probe.provenance.calibrated_utc.empty());
  EXPECT_EQ(tool("femoral guide").provenance.origin, provenance::Origin::Nominal);
}

// Turning tells the line: the guide's end stays as far along as it was declared, and nominal.
TEST_F(PivotCommand, TakesTheAxisIntoTheTools) {
  write_poses(3, {0.5, 0, -5}, [](int i) { return turned_by({0, 1, 0}, 0.75 * i); });
  const auto result = pivot(3, {"--spin"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const tools::Tool guide = tool("femoral guide");
  const Eigen::Vector3d declared_mm = tools::standard_tools().find_tool("femoral guide")->axis->point_mm;
  EXPECT_LT((guide.axis->point_mm - Eigen::Vector3d(0.5, declared_mm.y(), -5)).norm(), 1e-2);
  EXPECT_EQ(guide.nominal, tools::NominalParts{.end = true});
}

// By a simulated camera nothing real is measured, and the file says so for ever.
TEST_F(PivotCommand, Hazard26MarksWhatASimulatedCameraFound) {
  write_swing(28);
  set_in_camera("origin", "simulated");
  ASSERT_EQ(pivot(2).exit_code, 0);
  EXPECT_EQ(tool("probe").provenance.origin, provenance::Origin::Simulated);
}

// Each is told with exit code 4, and the tools stay as they stood.
TEST_F(PivotCommand, LeavesTheToolsAloneWhereNothingIsToBeReliedOn) {
  const std::string before = files::read_text(folder_ / "tools.json");
  write_swing(3);
  auto result = pivot(2);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr("cone"));
  write_swing(28);
  set_in_camera("reliable", false);
  result = pivot(2);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr("camera.json: the calibration is not reliable"));
  EXPECT_EQ(files::read_text(folder_ / "tools.json"), before);
}

// Where the origin is not known, or no tool is meant, nothing is begun.
TEST_F(PivotCommand, AsksForTheCameraAndForATool) {
  write_swing(28);
  const auto without = run_program({"pivot", "--marker", "2", "--poses", folder_ / "poses.csv", "--tools",
                                    folder_ / "tools.json", "--write-tools", folder_ / "tools.json", "-o",
                                    folder_ / "found.json"});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.errors, HasSubstr("--camera"));
  const auto nobodys = pivot(7);
  EXPECT_EQ(nobodys.exit_code, 3);
  EXPECT_THAT(nobodys.errors, HasSubstr("no tool carries marker 7"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "found.json"));
}

// It takes the world from the tools, whatever its id; without any word of it, no other marker for it.
TEST_F(PivotCommand, TakesTheWorldThatTheToolsDeclare) {
  std::vector<strokes::PoseRow> rows;
  for (int i = 0; i < 60; ++i) {
    const RigidTransform facing{Eigen::Quaterniond(0, 1, 0, 0), {0.02 * i, 1, 24}};
    rows.push_back({i, i / 30.0, 2, facing * turned_by({1, 0.3, 0}, 25 * std::sin(0.3 * i)), 0.1, {}, {}});
    rows.push_back({i,
                    i / 30.0,
                    10,
                    facing * RigidTransform{turned_by({1, 0, 0}, 20).rotation, {5, 5, 0}},
                    0.1,
                    {},
                    {}});
  }
  strokes::write_poses_file(folder_ / "poses.csv", rows);
  tools::ToolSet set = tools::standard_tools();
  set.world_markers = {{bones::BoneKind::Femur, 10, 4.0}};
  tools::write_tools_file(folder_ / "tools.json", set);
  std::vector<std::string> arguments{"pivot", "--marker",          "2", "--poses", folder_ / "poses.csv",
                                     "-o",    folder_ / "tip.json"};
  EXPECT_THAT(run_program(arguments).output, HasSubstr("no world marker in view"));
  arguments.insert(arguments.end(), {"--tools", folder_ / "tools.json"});
  EXPECT_THAT(run_program(arguments).output, HasSubstr("world: marker 10, 60 frames with both"));
  const auto written = [this] { return nlohmann::json::parse(files::read_text(folder_ / "tip.json")); };
  EXPECT_EQ(test::undescribed(written(), "tip"), "");
  arguments.emplace_back("--spin");
  (void)run_program(arguments);
  EXPECT_EQ(test::undescribed(written(), "axis"), "");
}

}  // namespace
}  // namespace arthronaut
