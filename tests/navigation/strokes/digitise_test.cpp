#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "navigation/strokes/curves.h"
#include "planning/geometry/error.h"

namespace arthronaut::strokes {

namespace {

tools::ToolSet probe_and_world() {
  tools::ToolSet tools;
  tools.world_markers.push_back({bones::BoneKind::Femur, 0, 4.0});
  tools::Tool probe;
  probe.name = "probe";
  probe.marker_id = 2;
  probe.tip_mm = Eigen::Vector3d(0, -38, -6);
  tools.tools.push_back(probe);
  tools::Tool guide;
  guide.name = "guide";
  guide.marker_id = 3;
  tools.tools.push_back(guide);
  return tools;
}

geometry::RigidTransform random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  geometry::RigidTransform pose;
  pose.rotation =
      Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
  pose.translation_mm = 20 * Eigen::Vector3d(normal(random), normal(random), normal(random));
  return pose;
}

// Rows of both markers with the tip at the given places of the world, the camera and the probe held anyhow.
std::vector<PoseRow> rows_for(const std::vector<Eigen::Vector3d>& tips_mm,
                              const std::vector<double>& times_s) {
  std::mt19937 random(4);
  std::vector<PoseRow> rows;
  for (std::size_t i = 0; i < tips_mm.size(); ++i) {
    PoseRow world;
    world.frame = static_cast<std::int64_t>(i);
    world.time_s = times_s[i];
    world.marker_id = 0;
    world.camera_from_marker = random_pose(random);
    geometry::RigidTransform world_from_probe = random_pose(random);
    world_from_probe.translation_mm = tips_mm[i] - world_from_probe.rotate(Eigen::Vector3d(0, -38, -6));
    PoseRow probe = world;
    probe.marker_id = 2;
    probe.camera_from_marker = world.camera_from_marker * world_from_probe;
    rows.push_back(probe);
    rows.push_back(world);
  }
  return rows;
}

std::vector<double> frame_times(std::size_t count) {
  std::vector<double> times_s(count);
  for (std::size_t i = 0; i < count; ++i) times_s[i] = static_cast<double>(i) / 60;
  return times_s;
}

}  // namespace

// The tip is found in the world whatever camera and probe do: rounding alone remains.
TEST(Digitise, TipIsSeenFromTheWorldMarker) {
  std::vector<Eigen::Vector3d> tips;
  for (int i = 0; i < 50; ++i) tips.push_back({0.5 * i, std::sin(0.2 * i), 3});
  const Curves curves =
      digitise(rows_for(tips, frame_times(tips.size())), probe_and_world(), bones::BoneKind::Femur, "probe");
  ASSERT_EQ(curves.size(), tips.size());
  for (std::size_t i = 0; i < tips.size(); ++i) {
    EXPECT_EQ(curves[i].curve, 0);
    EXPECT_LT((curves[i].position_mm - tips[i]).norm(), 1e-9);
    ASSERT_TRUE(curves[i].shaft_direction.has_value());
    EXPECT_NEAR(curves[i].shaft_direction->norm(), 1, 1e-9);
  }
}

// A hop, and a pause in tracking, end a stroke; what is left of a stroke that is too short is dropped.
TEST(Digitise, CutsAtHopsAndGapsAndDropsShortStrokes) {
  std::vector<Eigen::Vector3d> tips;
  for (int i = 0; i < 20; ++i) tips.push_back({0.5 * i, 0, 0});
  for (int i = 0; i < 3; ++i) tips.push_back({100 + 0.2 * i, 0, 0});  // 0.4 mm long
  for (int i = 0; i < 40; ++i) tips.push_back({0.5 * i, 50, 0});
  auto times_s = frame_times(tips.size());
  for (std::size_t i = 43; i < times_s.size(); ++i) times_s[i] += 0.5;  // the marker was covered
  const Curves curves = digitise(rows_for(tips, times_s), probe_and_world(), bones::BoneKind::Femur, "probe");
  ASSERT_EQ(curves.size(), 60u);
  EXPECT_EQ(curves[19].curve, 0);
  EXPECT_EQ(curves[20].curve, 1);
  EXPECT_EQ(curves[39].curve, 1);
  EXPECT_EQ(curves[40].curve, 2);
}

// Frames where one of the two markers is missing make no point; no point at all is no error.
TEST(Digitise, NeedsBothMarkersInTheSameFrame) {
  auto rows = rows_for({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, frame_times(3));
  std::erase_if(rows, [](const PoseRow& row) { return row.marker_id == 0; });
  EXPECT_TRUE(digitise(rows, probe_and_world(), bones::BoneKind::Femur, "probe").empty());
}

// What the tools don't declare is refused with its name.
TEST(Digitise, RefusesUndeclaredMarkersToolsAndTips) {
  EXPECT_THROW((void)digitise({}, probe_and_world(), bones::BoneKind::Tibia, "probe"), InvalidInput);
  EXPECT_THROW((void)digitise({}, probe_and_world(), bones::BoneKind::Femur, "hook"), InvalidInput);
  EXPECT_THROW((void)digitise({}, probe_and_world(), bones::BoneKind::Femur, "guide"), InvalidInput);
}

}  // namespace arthronaut::strokes
