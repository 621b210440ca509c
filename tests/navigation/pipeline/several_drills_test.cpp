// Of which of several drills with a marker of its own a frame tells.
#include <gtest/gtest.h>

#include "tests/navigation/pipeline/scripted_markers.h"

namespace arthronaut {
namespace {

using geometry::RigidTransform;
using markers::MarkerState;

constexpr int kFirst = 6, kSecond = 7;

// A registration that is the world's own frame, a plan of 30 mm, and no guide in view.
class SeveralDrills : public ::testing::Test {
 protected:
  SeveralDrills() {
    plan_.entry_mm = {3, -12, 20};
    plan_.direction = Eigen::Vector3d(-0.8, 0, 0.6);
    pipeline::PipelineOptions options = test::scripted_options();
    tools::Tool second = test::scripted_drill();
    second.name = "tibial drill";
    second.marker_id = kSecond;
    options.tools.tools.push_back(test::scripted_drill());
    options.tools.tools.push_back(second);
    pipeline_ = std::make_unique<pipeline::NavigationPipeline>(
        options, std::make_unique<test::ScriptedMarkers>(&script_));
    pipeline_->set_plan(plan_, 30);
    registration::RegistrationSummary registration;
    registration.has_pose = registration.reliable = true;
    pipeline_->set_registration(registration);
  }

  // Its tip so deep along the plan, and so far beside it.
  [[nodiscard]] markers::MarkerObservation drill(int id, double depth_mm, double beside_mm = 0) const {
    RigidTransform world_from_drill;
    world_from_drill.rotation =
        Eigen::Quaterniond::FromTwoVectors(-Eigen::Vector3d::UnitY(), plan_.direction);
    const Eigen::Vector3d tip =
        plan_.entry_mm + depth_mm * plan_.direction + beside_mm * plan_.direction.unitOrthogonal();
    world_from_drill.translation_mm = tip - world_from_drill.rotate(*test::scripted_drill().tip_mm);
    return test::seen(id, camera_from_world_ * world_from_drill);
  }
  const std::optional<guidance::DrillDepth>& told(const markers::MarkerObservation& first,
                                                  const markers::MarkerObservation& second) {
    script_ = {test::seen(0, camera_from_world_), test::lost(2, MarkerState::NotSeen),
               test::lost(3, MarkerState::NotSeen), first, second};
    pipeline_->process(test::plain_frame(index_, static_cast<std::uint8_t>(1 + index_)), result_);
    ++index_;
    return result_.guidance.drill;
  }
  [[nodiscard]] static markers::MarkerObservation away(int id) {
    return test::lost(id, MarkerState::NotSeen);
  }

 private:
  RigidTransform camera_from_world_{
      Eigen::Quaterniond(Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 0.2, 0.1).normalized())), {1, 2, 60}};
  tunnels::Tunnel plan_;
  std::vector<markers::MarkerObservation> script_{5};
  std::unique_ptr<pipeline::NavigationPipeline> pipeline_;
  pipeline::FrameResult result_;
  std::int64_t index_ = 0;
};

// Whichever was declared first: the femur's drill in its tray says nothing of the one that drills the tibia.
TEST_F(SeveralDrills, Hazard7TheOneThatIsSeenIsToldOf) {
  const auto& second = told(away(kFirst), drill(kSecond, 29));
  ASSERT_TRUE(second);
  EXPECT_NEAR(second->depth_mm, 29, 1e-6);
  EXPECT_EQ(second->breakout, guidance::Breakout::Imminent);
  EXPECT_EQ(second->marker_id, kSecond);
  const auto& first = told(drill(kFirst, 12), away(kSecond));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->marker_id, kFirst);
  EXPECT_FALSE(told(away(kFirst), away(kSecond)));
}

// Of two the one in the tunnel, be it too deep: one that waits before the entry hides no warning.
TEST_F(SeveralDrills, Hazard7OfTwoThatAreSeenTheOneInTheTunnelIsToldOf) {
  EXPECT_EQ(told(drill(kFirst, -60, 30), drill(kSecond, 12))->marker_id, kSecond);
  EXPECT_EQ(told(drill(kFirst, 12), drill(kSecond, 12, 9))->marker_id, kFirst);
  const auto& deep = told(drill(kFirst, -8), drill(kSecond, 45, 1));
  EXPECT_EQ(deep->marker_id, kSecond);
  EXPECT_EQ(deep->breakout, guidance::Breakout::Through);
}

// Two that are as near as each other: what is told of does not change with the noise of their poses, but when
// another one is clearly the one that drills, and at once when it is in the tunnel and the other one is not.
TEST_F(SeveralDrills, Hazard7OfTwoThatAreAsNearOneIsToldOf) {
  ASSERT_EQ(told(drill(kFirst, 12, 0.5), drill(kSecond, 12, 0.7))->marker_id, kFirst);
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(told(drill(kFirst, 12, 0.7 - 0.2 * (i % 2)), drill(kSecond, 12, 0.6))->marker_id, kFirst) << i;
  EXPECT_EQ(told(drill(kFirst, 12, 4), drill(kSecond, 12, 0.6))->marker_id, kSecond);
  EXPECT_EQ(told(drill(kFirst, 12, 0.5), drill(kSecond, 12, 0.6))->marker_id, kSecond);
  EXPECT_EQ(told(drill(kFirst, 12, 0.5), drill(kSecond, -1, 0.6))->marker_id, kFirst);
  EXPECT_EQ(told(away(kFirst), drill(kSecond, -1, 0.6))->marker_id, kSecond);
}

}  // namespace
}  // namespace arthronaut
