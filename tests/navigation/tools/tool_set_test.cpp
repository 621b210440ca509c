#include "navigation/tools/tool_set.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::tools {
namespace {

class ToolsFile : public ::testing::Test {
 protected:
  void write(const std::string& world, const std::string& tools) {
    std::ofstream(file_) << R"({"format": "arthronaut.tools", "version": 1, "world_markers": [)" << world
                         << R"(], "tools": [)" << tools << "]}";
  }
  // The message with which the file is refused.
  std::string refusal() {
    return test::message_of<InvalidInput>([&] { (void)read_tools_file(file_); });
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "tools.json";
};

// What is written is what is read, to the last bit.
TEST_F(ToolsFile, KeepsTheStandardToolsThroughARoundTrip) {
  ToolSet written = standard_tools();
  written.tools.front().residual_mm = 0.0625;  // of its calibration; the others have none
  write_tools_file(file_, written);
  const ToolSet read = read_tools_file(file_);
  ASSERT_EQ(read.world_markers.size(), written.world_markers.size());
  for (std::size_t i = 0; i < read.world_markers.size(); ++i) {
    EXPECT_EQ(read.world_markers[i].bone, written.world_markers[i].bone);
    EXPECT_EQ(read.world_markers[i].marker_id, written.world_markers[i].marker_id);
    EXPECT_EQ(read.world_markers[i].size_mm, written.world_markers[i].size_mm);
  }
  ASSERT_EQ(read.tools.size(), written.tools.size());
  for (std::size_t i = 0; i < read.tools.size(); ++i) {
    EXPECT_EQ(read.tools[i].name, written.tools[i].name);
    EXPECT_EQ(read.tools[i].tip_mm, written.tools[i].tip_mm);
    EXPECT_EQ(read.tools[i].residual_mm, written.tools[i].residual_mm);
    ASSERT_EQ(read.tools[i].axis.has_value(), written.tools[i].axis.has_value());
    if (read.tools[i].axis) {
      EXPECT_EQ(read.tools[i].axis->point_mm, written.tools[i].axis->point_mm);
      EXPECT_EQ(read.tools[i].axis->direction, written.tools[i].axis->direction);
    }
  }
}

// Tip and axis carry how well they are known; a drill says that it is one.
TEST_F(ToolsFile, Hazard6KeepsHowWellTheToolsAreKnown) {
  ToolSet written = standard_tools();
  Eigen::Matrix3d covariance;
  covariance << 0.01, 0.002, 0, 0.002, 0.04, 0.001, 0, 0.001, 0.02;
  written.tools[0].tip_covariance_mm2 = covariance;
  written.tools[1].axis_point_sigma_mm = 0.07;
  written.tools[1].axis_direction_sigma_deg = 0.11;
  written.tools[1].nominal = {.tip = true, .end = true};
  Tool drill;
  drill.name = "drill";
  drill.marker_id = 7;
  drill.tip_mm = Eigen::Vector3d(0, -80, -4);
  drill.axis = ToolAxis{*drill.tip_mm, -Eigen::Vector3d::UnitY()};
  drill.kind = ToolKind::Drill;
  written.tools.push_back(drill);
  write_tools_file(file_, written);
  const ToolSet read = read_tools_file(file_);
  EXPECT_EQ(read.tools[0].tip_covariance_mm2, written.tools[0].tip_covariance_mm2);
  EXPECT_EQ(tip_error_mm2(read.tools[0]), covariance);
  EXPECT_EQ(axis_error(read.tools[1]).point_sigma_mm, 0.07);
  EXPECT_NEAR(geometry::deg_from_rad(axis_error(read.tools[1]).direction_sigma_rad), 0.11, 1e-12);
  EXPECT_FALSE(read.tools[2].axis_point_sigma_mm);
  EXPECT_EQ(read.tools.back().kind, ToolKind::Drill);
}

// A nominal tool is worse than a measured one, and neither is exact; one number stands for every direction.
TEST_F(ToolsFile, Hazard6ANominalToolIsNotExact) {
  Tool tool = standard_tools().tools.front();
  EXPECT_NEAR(tip_error_mm2(tool)(0, 0), 0.3 * 0.3, 1e-12);
  tool.residual_mm = 0.2;
  EXPECT_NEAR(tip_error_mm2(tool)(0, 0), 0.1 * 0.1, 1e-12);
  write("",
        R"({"name": "probe", "marker_id": 2, "size_mm": 4, "tip_mm": [0, -20, -5], "tip_sigma_mm": 0.5})");
  EXPECT_NEAR(tip_error_mm2(read_tools_file(file_).tools.front())(2, 2), 0.25, 1e-12);
  write("", R"({"name": "probe", "marker_id": 2, "size_mm": 4, "tip_mm": [0, -20, -5], "tip_sigma_mm": -1})");
  EXPECT_NE(refusal().find("tip_sigma_mm"), std::string::npos);
}

// A drill without tip or axis could say nothing about depth.
TEST_F(ToolsFile, Hazard7ADrillNeedsTipAndAxis) {
  write("", R"({"name": "drill", "marker_id": 2, "size_mm": 4, "kind": "drill", "tip_mm": [0, -20, -5]})");
  EXPECT_NE(refusal().find("a drill needs"), std::string::npos);
  write("", R"({"name": "saw", "marker_id": 2, "size_mm": 4, "kind": "saw"})");
  EXPECT_NE(refusal().find("\"saw\""), std::string::npos);
}

// The ids are those that interfaces.md promises.
TEST(StandardTools, CarryTheStandardIds) {
  const ToolSet set = standard_tools();
  EXPECT_EQ(set.find_world_marker(bones::BoneKind::Femur)->marker_id, 0);
  EXPECT_EQ(set.find_world_marker(bones::BoneKind::Tibia)->marker_id, 1);
  EXPECT_EQ(set.find_tool("probe")->marker_id, 2);
  EXPECT_TRUE(set.find_tool("probe")->tip_mm.has_value());
  EXPECT_EQ(set.find_tool("femoral guide")->marker_id, 3);
  EXPECT_TRUE(set.find_tool("femoral guide")->axis.has_value());
  EXPECT_EQ(set.find_tool("tibial guide")->marker_id, 4);
  EXPECT_EQ(set.find_tool("spoon"), nullptr);
}

// One id on two things would give one of them the other's pose.
TEST_F(ToolsFile, RefusesAMarkerDeclaredTwice) {
  write(R"({"bone": "femur", "marker_id": 2, "size_mm": 4})",
        R"({"name": "probe", "marker_id": 2, "size_mm": 4})");
  EXPECT_NE(refusal().find("tools[0].marker_id"), std::string::npos) << refusal();
  EXPECT_NE(refusal().find("world marker of the femur"), std::string::npos) << refusal();
}

// Each break of the contract has its own message with the place in it.
TEST_F(ToolsFile, NamesThePlaceOfWhatItRefuses) {
  write("", R"({"name": "probe", "marker_id": 50, "size_mm": 4})");
  EXPECT_NE(refusal().find("marker_id: must be 0 to 49"), std::string::npos) << refusal();
  write("", R"({"name": "probe", "marker_id": 2, "size_mm": 0})");
  EXPECT_NE(refusal().find("tools[0].size_mm"), std::string::npos) << refusal();
  write("", R"({"name": "probe", "marker_id": 2, "size_mm": 4000})");
  EXPECT_NE(refusal().find("tools[0].size_mm: is 4000 mm"), std::string::npos) << refusal();
  write(R"({"bone": "femur", "marker_id": 0, "size_mm": 0.004})", "");
  EXPECT_NE(refusal().find("world_markers[0].size_mm: is 0.004 mm"), std::string::npos) << refusal();
  write(
      "",
      R"({"name": "guide", "marker_id": 3, "size_mm": 4, "axis_point_mm": [0,0,0], "axis_direction": [0,0,0]})");
  EXPECT_NE(refusal().find("axis_direction: must not be zero"), std::string::npos) << refusal();
  write("", R"({"name": "guide", "marker_id": 3, "size_mm": 4, "axis_direction": [0,1,0]})");
  EXPECT_NE(refusal().find("axis_point_mm"), std::string::npos) << refusal();
  write(R"({"bone": "patella", "marker_id": 2, "size_mm": 4})", "");
  EXPECT_NE(refusal().find("world_markers[0].bone"), std::string::npos) << refusal();
  write("", R"({"name": "a", "marker_id": 2, "size_mm": 4}, {"name": "a", "marker_id": 3, "size_mm": 4})");
  EXPECT_NE(refusal().find("tools[1].name"), std::string::npos) << refusal();
  write("", R"({"name": "a", "marker_id": 2, "size_mm": 4, "tip_mm": [0, 1e999, 0]})");
  EXPECT_FALSE(refusal().empty());
}

// Where each marker lies, and how well that is known, survives the file to the last bit.
TEST_F(ToolsFile, KeepsTheMarkersOfABody) {
  ToolSet written = standard_tools();
  const geometry::RigidTransform tilted{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized())), {1.25, 8.5, -0.75}};
  written.tools[0].markers = {{2, 4.0, {}}, {12, 3.0, tilted, 0.02, 0.15}};
  written.world_markers[1].markers = {{1, 4.0, tilted}, {11, 5.0, tilted.inverse()}};
  written.world_markers[1].marker_id = 1;
  write_tools_file(file_, written);
  const ToolSet read = read_tools_file(file_);
  EXPECT_TRUE(are_same(read.tools[0].markers, written.tools[0].markers));
  EXPECT_TRUE(are_same(read.world_markers[1].markers, written.world_markers[1].markers));
  EXPECT_EQ(read.tools[0].markers[1].sigma_mm, 0.02);
  EXPECT_EQ(read.tools[0].markers[1].sigma_deg, 0.15);
  EXPECT_EQ(read.tools[0].marker_id, 2);
  EXPECT_EQ(read.world_markers[1].size_mm, 4.0);
  EXPECT_TRUE(read.tools[1].markers.empty());
  EXPECT_TRUE(read.has_bodies_of_several());
  EXPECT_FALSE(standard_tools().has_bodies_of_several());
}

// A marker's place is said once, is a place, and is no other marker's.
TEST_F(ToolsFile, NamesWhatIsWrongWithTheMarkersOfABody) {
  const std::string at = R"("tool_from_marker": {"q_wxyz": [1, 0, 0, 0], "t_mm": [0, 0, 0]})";
  const std::string first = R"({"marker_id": 2, "size_mm": 4, )" + at + "}";
  const auto tool = [&](const std::string& second, const std::string& more = "") {
    write(R"({"bone": "femur", "marker_id": 0, "size_mm": 4})",
          R"({"name": "probe", "markers": [)" + first + ", " + second + "]" + more + "}");
    return refusal();
  };
  const auto marker = [](const std::string& id, const std::string& q, const std::string& t) {
    return R"({"marker_id": )" + id + R"(, "size_mm": 4, "tool_from_marker": {"q_wxyz": )" + q +
           R"(, "t_mm": )" + t + "}}";
  };
  EXPECT_NE(
      tool(marker("0", "[1,0,0,0]", "[0,9,0]")).find("tools[0].markers[1].marker_id: marker 0 is already"),
      std::string::npos)
      << refusal();
  EXPECT_NE(tool(marker("2", "[1,0,0,0]", "[0,9,0]")).find("already declared by tool \"probe\""),
            std::string::npos);
  EXPECT_NE(tool(marker("7", "[1,1,0,0]", "[0,9,0]")).find("tool_from_marker.q_wxyz: must have unit norm"),
            std::string::npos)
      << refusal();
  EXPECT_NE(tool(marker("7", "[1,0,0,0]", "[0,1e999,0]")).find("out of range"), std::string::npos)
      << refusal();
  EXPECT_NE(tool(marker("7", "[1,0,0,0]", "[0,1,0]")).find("lies on marker 2"), std::string::npos)
      << refusal();
  EXPECT_NE(tool(R"({"marker_id": 7, "size_mm": 4})").find("tool_from_marker"), std::string::npos)
      << refusal();
  EXPECT_NE(tool(marker("7", "[1,0,0,0]", "[0,9,0]"), R"(, "marker_id": 8)").find("beside \"markers\""),
            std::string::npos)
      << refusal();
  write("", R"({"name": "probe", "markers": []})");
  EXPECT_NE(refusal().find("tools[0].markers: must be 1 to 16"), std::string::npos) << refusal();
  // On the plate's other face the same place is another one.
  write("", R"({"name": "probe", "markers": [)" + first + ", " + marker("7", "[0,0,1,0]", "[0,0,-1]") + "]}");
  EXPECT_EQ(read_tools_file(file_).tools[0].markers.size(), 2U);
}

// A direction of any length is a direction.
TEST_F(ToolsFile, NormalisesTheAxis) {
  write(
      "",
      R"({"name": "g", "marker_id": 3, "size_mm": 4, "axis_point_mm": [0,0,0], "axis_direction": [0,-3,4]})");
  EXPECT_NEAR((read_tools_file(file_).tools[0].axis->direction - Eigen::Vector3d(0, -0.6, 0.8)).norm(), 0,
              1e-15);
}

// Who sees the tools, and how wrong that is; what is not said stays unsaid.
TEST_F(ToolsFile, KeepsAnOutsideTracker) {
  ToolSet set = standard_tools();
  write_tools_file(file_, set);
  EXPECT_FALSE(read_tools_file(file_).tracker);
  set.tracker.emplace();
  write_tools_file(file_, set);
  ASSERT_TRUE(read_tools_file(file_).tracker);
  EXPECT_FALSE(read_tools_file(file_).tracker->has_known_error());
  set.tracker =
      OutsideTracker{"igtl://tracker", 0.25, 0.1, {{"femur", "Reference"}, {"probe", "Stylus"}}, true};
  write_tools_file(file_, set);
  const auto again = read_tools_file(file_).tracker;
  ASSERT_TRUE(again);
  EXPECT_EQ(again->address, "igtl://tracker");
  EXPECT_EQ(again->sigma_mm, 0.25);
  EXPECT_EQ(again->sigma_deg, 0.1);
  EXPECT_TRUE(again->may_repeat);
  EXPECT_EQ(again->devices, set.tracker->devices);
}

TEST_F(ToolsFile, NamesWhatIsWrongWithATracker) {
  const auto refusal_of = [&](const std::string& tracker) {
    std::ofstream(file_) << R"({"format": "arthronaut.tools", "version": 1,
      "world_markers": [{"bone": "femur", "marker_id": 0, "size_mm": 4}],
      "tools": [{"name": "probe", "marker_id": 2, "size_mm": 4}], "tracker": )"
                         << tracker << "}";
    return test::message_of<InvalidInput>([&] { (void)read_tools_file(file_); });
  };
  EXPECT_NE(refusal_of(R"({"sigma_mm": -1})").find("sigma_mm"), std::string::npos);
  EXPECT_NE(refusal_of(R"({"devices": [{"of": "tibia", "name": "A"}]})").find("not declared"),
            std::string::npos);
  EXPECT_NE(refusal_of(R"({"devices": [{"of": "drill", "name": "A"}]})").find("not declared"),
            std::string::npos);
  EXPECT_NE(refusal_of(R"({"devices": [{"of": "probe", "name": ""}]})").find("1 to 20"), std::string::npos);
  EXPECT_NE(refusal_of(R"({"devices": [{"of": "probe", "name": "A"}, {"of": "femur", "name": "A"}]})")
                .find("is the probe already"),
            std::string::npos);
  EXPECT_NE(refusal_of(R"({"devices": [{"of": "probe", "name": "A"}, {"of": "probe", "name": "B"}]})")
                .find("has a name already"),
            std::string::npos);
}

}  // namespace
}  // namespace arthronaut::tools
