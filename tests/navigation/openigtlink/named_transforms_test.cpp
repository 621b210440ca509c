// What of an operation's state is told to other programs, under which names and in whose axes.
#include "navigation/openigtlink/named_transforms.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "navigation/openigtlink/igtl_messages.h"
#include "navigation/openigtlink/ras_from_lps.h"
#include "tests/navigation/openigtlink/served_state.h"

namespace arthronaut::openigtlink {
namespace {

// A point of the bone goes the same way by Slicer's coordinates as by ours.
TEST(RasFromLps, IsTheSameMotionInTheOtherAxes) {
  const Eigen::Vector3d flip(-1, -1, 1), point(3, -7, 11);
  const geometry::RigidTransform lps = test::made_pose(2), ras = ras_from_lps(lps);
  const Eigen::Vector3d in_ras = ras * point.cwiseProduct(flip);
  EXPECT_LT((in_ras - (lps * point).cwiseProduct(flip)).norm(), 1e-12);
}

TEST(NamedTransforms, HoldWhatIsValidAndNothingElse) {
  operation::OperationState state = test::made_state();
  std::map<std::string, geometry::RigidTransform> named;
  for (const NamedTransform& t : named_transforms(state)) named[t.name] = t.target_from_source;
  ASSERT_EQ(named.size(), 4U);
  EXPECT_TRUE(named.contains("WorldFemur") && named.contains("Guide_World") && named.contains("Bone_World"));
  const Eigen::Vector3d tip_in_world = test::made_pose(2) * Eigen::Vector3d(0, -38, -6);
  EXPECT_LT(
      (named.at("ProbeTip_World").translation_mm - tip_in_world.cwiseProduct(Eigen::Vector3d(-1, -1, 1)))
          .norm(),
      1e-12);
  auto doubted = std::make_shared<operation::RegistrationState>(*state.registration);
  doubted->in_force.standing = operation::Standing::Void;
  state.registration = doubted;
  state.frame.camera_from_world.is_valid = false;
  for (const NamedTransform& t : named_transforms(state)) {
    EXPECT_NE(t.name, "Bone_World");
    EXPECT_NE(t.name, "WorldFemur");
  }
  // Guidance by the guide alone is OK, and says nothing of the probe: that one is not sent.
  state = test::made_state();
  state.frame.guidance.state = guidance::GuidanceState::Valid;
  state.frame.tools[0].world_from_tool.is_valid = false;
  EXPECT_TRUE(status_of(state).is_ok);
  for (const NamedTransform& t : named_transforms(state)) EXPECT_NE(t.name, "ProbeTip_World");
  state.has_source = false;
  EXPECT_TRUE(named_transforms(state).empty());
}

// The femur's drill and the tibia's: who reads one of them never gets the other one's pose.
TEST(NamedTransforms, TwoDrillsHaveANameEach) {
  operation::OperationState state = test::made_state();
  EXPECT_FALSE(has_second_drill(state));
  auto source = std::make_shared<operation::SourceSetup>(*state.source);
  source->pipeline.tools.tools.push_back(source->pipeline.tools.tools.back());
  source->pipeline.tools.tools.back().name = "tibial drill";
  source->pipeline.tools.tools.back().marker_id = 10;
  state.source = source;
  EXPECT_TRUE(has_second_drill(state));
  state.frame.tools.push_back({10, {test::made_pose(6), 0, true}});
  const auto drills = [&] {
    std::map<std::string, double> x_mm;
    for (const NamedTransform& t : named_transforms(state))
      if (t.name.starts_with("Drill")) x_mm[t.name] = -t.target_from_source.translation_mm.x();
    return x_mm;
  };
  using Drills = std::map<std::string, double>;
  EXPECT_EQ(drills(), (Drills{{"Drill2_World", 60}})) << "the first one is not seen";
  state.frame.tools[2].world_from_tool.is_valid = true;
  EXPECT_EQ(drills(), (Drills{{"Drill_World", 40}, {"Drill2_World", 60}}));
}

// Which of two drills the depth is told of stands behind the reason; of one alone nothing is added.
TEST(Status, Hazard7SaysWhichOfTwoDrillsTheDepthIsOf) {
  operation::OperationState state = test::made_state();
  state.frame.guidance.drill.emplace().marker_id = 9;
  EXPECT_EQ(status_of(state).reason, "drill guide not seen");
  auto source = std::make_shared<operation::SourceSetup>(*state.source);
  source->pipeline.tools.tools.push_back(source->pipeline.tools.tools.back());
  source->pipeline.tools.tools.back().name = "tibial drill";
  source->pipeline.tools.tools.back().marker_id = 10;
  state.source = source;
  EXPECT_EQ(status_of(state).reason, "drill guide not seen, depth of drill (Drill_World)");
  state.frame.guidance.drill->marker_id = 10;
  EXPECT_EQ(status_of(state).reason, "drill guide not seen, depth of tibial drill (Drill2_World)");
  state.frame.guidance.state = guidance::GuidanceState::Valid;
  EXPECT_TRUE(status_of(state).is_ok);
  EXPECT_EQ(status_of(state).reason, "OK, simulation, depth of tibial drill (Drill2_World)");
  state.frame.guidance.drill.reset();
  EXPECT_EQ(status_of(state).reason, "OK, simulation");
}

}  // namespace
}  // namespace arthronaut::openigtlink
