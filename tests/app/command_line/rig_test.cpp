// rig on poses of a body whose markers' places are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "navigation/strokes/poses_file.h"
#include "navigation/tools/tool_set.h"
#include "planning/files/atomic_file.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "tests/app/command_line/program.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using geometry::RigidTransform;
using test::run_program;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

RigidTransform turned(const Eigen::Vector3d& axis, double deg, const Eigen::Vector3d& at_mm) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(geometry::rad_from_deg(deg), axis.normalized())), at_mm};
}

class RigCommand : public ::testing::Test {
 protected:
  // Markers 2 and 12 on the probe, 0 in the world; marker 12 moves at a frame, or is never seen with 2.
  void write_poses(double cone_deg, int moves_at = -1, bool is_apart = false,
                   std::optional<double> size_mm = std::nullopt) {
    std::vector<strokes::PoseRow> rows;
    for (int i = 0; i < 240; ++i) {
      const double t = i / 30.0;
      const RigidTransform facing{Eigen::Quaterniond(0, 1, 0, 0), {std::sin(t), 1, 24}};
      const RigidTransform pose = facing * turned({1, 0, 0}, cone_deg * std::sin(1.7 * t), {0, 0, 0}) *
                                  turned({0, 1, 0}, cone_deg * std::cos(1.1 * t), {0, 0, 0});
      const RigidTransform slipped =
          i >= moves_at && moves_at >= 0 ? turned({1, 0, 0}, 1.5, {0.4, 0, 0}) : RigidTransform();
      const auto add = [&](int id, const RigidTransform& camera_from_marker) {
        rows.push_back({i, t, id, camera_from_marker, 0.1, std::nullopt, size_mm});
      };
      add(0, facing);
      if (!is_apart || i < 120) add(2, pose);
      if (!is_apart || i >= 120) add(12, pose * second_ * slipped);
    }
    strokes::write_poses_file(folder_ / "poses.csv", rows);
  }
  [[nodiscard]] test::ProgramResult rig(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"rig",   "--poses", folder_ / "poses.csv", "--tool",
                                       "probe", "-o",      folder_ / "out.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  void expect_places(const tools::Tool& tool, const RigidTransform& body_from_first) const {
    ASSERT_EQ(tool.markers.size(), 2U);
    const RigidTransform second = body_from_first * second_;
    EXPECT_LT((tool.markers[1].body_from_marker.translation_mm - second.translation_mm).norm(), 1e-3);
    EXPECT_LT((tool.markers[0].body_from_marker.translation_mm - body_from_first.translation_mm).norm(),
              1e-3);
    EXPECT_TRUE(tool.markers[1].sigma_mm.has_value());
  }

  const RigidTransform second_ = turned({0, 1, 0}, 25, {5.6, 2, -1.4});
  test::TemporaryFolder folder_;
};

// Without tools the standard ones: the probe keeps its frame and its tip.
TEST_F(RigCommand, PutsTheMarkersOnTheTool) {
  write_poses(25);
  const auto result = rig();
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("2 markers"), HasSubstr("marker 12")));
  const tools::ToolSet set = tools::read_tools_file(folder_ / "out.json");
  const tools::Tool* probe = set.find_tool("probe");
  ASSERT_NE(probe, nullptr);
  expect_places(*probe, {});
  EXPECT_EQ(probe->tip_mm, tools::standard_tools().find_tool("probe")->tip_mm);
  EXPECT_EQ(set.find_world_marker(bones::BoneKind::Femur)->marker_id, 0);
}

// From other tools, where marker 12 had a tool of its own so that it was tracked; the frame goes to marker
// 12, and the tip with it.
TEST_F(RigCommand, TakesTheFrameThatIsAskedFor) {
  write_poses(25);
  tools::ToolSet set = tools::standard_tools();
  set.tools.push_back({"second", 12, 3.0, std::nullopt, std::nullopt});
  tools::write_tools_file(folder_ / "tools.json", set);
  const auto result = rig({"--tools", folder_ / "tools.json", "--reference", "12"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const tools::ToolSet found = tools::read_tools_file(folder_ / "out.json");
  EXPECT_EQ(found.find_tool("second"), nullptr);
  const tools::Tool* probe = found.find_tool("probe");
  expect_places(*probe, second_.inverse());
  EXPECT_EQ(probe->markers[1].size_mm, 3.0);
  EXPECT_LT((*probe->tip_mm - second_.inverse() * *set.find_tool("probe")->tip_mm).norm(), 1e-3);
}

// Each with its reason and exit code 4, written, but not as tools that would guide; tools that stood there
// are still there.
TEST_F(RigCommand, RefusesWhatCannotBeReliedOn) {
  write_poses(25, -1, true);
  auto result = rig();
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr("marker 12 is not seen together"));
  write_poses(1);
  result = rig();
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr("too little motion"));
  write_poses(25, 120);
  result = rig();
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr("marker 12 moved on the body"));
  EXPECT_THAT(folder_.names(), ElementsAre("out.json", "poses.csv"));
  const auto written = files::read_json(folder_ / "out.json", "arthronaut.doubtful_rig", 1);
  EXPECT_FALSE(written.boolean("reliable"));
  EXPECT_THAT(written.texts("reasons").front(), HasSubstr("marker 12 moved on the body"));
  EXPECT_EQ(written.objects("markers").size(), 2U);
  EXPECT_THROW((void)tools::read_tools_file(folder_ / "out.json"), InvalidInput);

  tools::write_tools_file(folder_ / "out.json", tools::standard_tools());
  EXPECT_EQ(rig().exit_code, 4);
  EXPECT_NO_THROW((void)tools::read_tools_file(folder_ / "out.json"));
  EXPECT_THAT(folder_.names(), ElementsAre("out.doubtful.json", "out.json", "poses.csv"));
}

// A size that nobody has said is never taken in silence, on standard output's own side either.
TEST_F(RigCommand, SaysWhatSizeItTakes) {
  write_poses(25);
  EXPECT_THAT(rig().output, HasSubstr("marker 2, 12: taken to be 4 mm wide"));
  const auto piped = run_program({"rig", "--poses", folder_ / "poses.csv", "--tool", "probe", "-o", "-"});
  EXPECT_THAT(piped.errors, HasSubstr("taken to be 4 mm wide"));
  EXPECT_THAT(piped.output, ::testing::StartsWith("{"));
  const auto said = rig({"--size-mm", "4"});
  EXPECT_THAT(said.output + said.errors, ::testing::Not(HasSubstr("taken to be")));
}

// The size that poses were found with comes with them; where the tools, or the command, say another, what is
// measured and what it would be used with are in different proportions.
TEST_F(RigCommand, TakesTheSizeThatThePosesWereFoundWith) {
  write_poses(25, -1, false, 2.89);
  const auto result = rig();
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, ::testing::Not(HasSubstr("taken to be")));
  EXPECT_EQ(tools::read_tools_file(folder_ / "out.json").find_tool("probe")->markers[1].size_mm, 2.89);
  tools::write_tools_file(folder_ / "tools.json", tools::standard_tools());
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--tools", folder_ / "tools.json"}, {"--size-mm", "4"}}) {
    const auto refused = rig(more);
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_THAT(refused.errors,
                AllOf(HasSubstr("poses.csv"), HasSubstr("size_mm"), HasSubstr("was taken for 2.89 mm")));
  }
}

// Wrong input names what is wrong.
TEST_F(RigCommand, NamesWhatIsWrong) {
  write_poses(25);
  EXPECT_THAT(rig({"--markers", "2"}).errors, HasSubstr("fewer than two markers"));
  EXPECT_EQ(rig({"--markers", "2"}).exit_code, 3);
  EXPECT_THAT(rig({"--markers", "2,12", "--reference", "5"}).errors, HasSubstr("reference"));
  EXPECT_EQ(rig({"--size-mm", "-1"}).exit_code, 2);
  EXPECT_THAT(rig({"--markers", "0,2,12"}).errors, HasSubstr("world marker of the femur"));
}

}  // namespace
}  // namespace arthronaut
