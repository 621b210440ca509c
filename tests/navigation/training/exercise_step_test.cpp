#include "navigation/training/exercise_step.h"

#include <gtest/gtest.h>

#include "navigation/simulator/simulated_operation.h"

namespace arthronaut::training {
namespace {

using simulator::Held;

std::string step(Goal goal, Held held, const auto& change) {
  operation::OperationState state;
  simulator::HandState hand;
  hand.held = held;
  change(state, hand);
  return exercise_step(goal, state, hand);
}
constexpr auto kNothing = [](operation::OperationState&, simulator::HandState&) {};

// What the operation asks for (to draw, to register) is no part of finding a tip, or of aiming.
TEST(ExerciseStep, OfAPartIsItsOwn) {
  EXPECT_EQ(step(Goal::Pivot, Held::Probe, kNothing), "set the probe's tip on the bone");
  EXPECT_EQ(step(Goal::Pivot, Held::Probe, [](auto&, auto& hand) { hand.touches_bone = true; }),
            "tilt the handle to all sides, then Enter: done");
  EXPECT_EQ(step(Goal::Pivot, Held::Guide, kNothing), "take the probe: G");
  EXPECT_EQ(step(Goal::Aim, Held::Guide, kNothing), "bring the guide into view");
  EXPECT_EQ(step(Goal::Aim, Held::Guide,
                 [](auto& state, auto&) {
                   state.guided_lately = true;
                   state.frame.guidance.state = guidance::GuidanceState::Valid;
                 }),
            "follow the bullseye; on the plan: Enter, done");
  EXPECT_EQ(step(Goal::Aim, Held::Guide,
                 [](auto& state, auto&) {
                   state.guided_lately = true;
                   state.frame.guidance.state = guidance::GuidanceState::WorldMarkerLost;
                 }),
            "bring the bone's marker into view");
  EXPECT_EQ(step(Goal::Aim, Held::Guide,
                 [](auto& state, auto&) {
                   state.guided_lately = true;
                   state.frame.guidance.state = guidance::GuidanceState::GuideLost;
                 }),
            "bring the guide into view")
      << "there is no bullseye to follow";
  EXPECT_EQ(step(Goal::Aim, Held::Probe, kNothing), "take the guide: G");
}

// Where the operation itself is practised its own steps lead, until what was to be reached is.
TEST(ExerciseStep, OfAnOperationIsTheOperationsUntilItIsReached) {
  EXPECT_EQ(step(Goal::Register, Held::Probe, kNothing), "");
  EXPECT_EQ(step(Goal::Drill, Held::Guide, kNothing), "");
  EXPECT_EQ(step(Goal::Drill, Held::Guide,
                 [](auto& state, auto&) { state.verification = operation::Verification::ByTouches; }),
            "");
  EXPECT_EQ(step(Goal::Register, Held::Probe,
                 [](auto& state, auto&) { state.verification = operation::Verification::ByTouches; }),
            "verified: Enter, done");
  EXPECT_EQ(
      step(Goal::Drill, Held::Guide,
           [](auto& state, auto&) { state.drilled.outcome = operation::DrilledState::Outcome::Recorded; }),
      "drilled: Enter, done");
}

// The lens at the origin, a plate of 6 x 6 mm before it at 10 mm.
std::string way_back(const Eigen::Vector3d& tip_mm, Held held = Held::Probe) {
  geometry::TriangleMesh plate;
  plate.vertices_mm = {{-3, -3, 10}, {3, -3, 10}, {3, 3, 10}, {-3, 3, 10}};
  plate.triangles = {{0, 2, 1}, {0, 3, 2}};
  simulator::HandState hand;
  hand.held = held;
  hand.probe_tip_mm = held == Held::Probe ? tip_mm : Eigen::Vector3d(0, 0, 20);
  hand.guide_point_mm = held == Held::Guide ? tip_mm : Eigen::Vector3d(0, 0, 20);
  const camera::Calibration scope = simulator::standard_camera();
  return way_back_into_view(hand, camera::CameraModel(scope, 0, scope.refractive_index),
                            geometry::Surface(plate));
}

// A trainee at the keys does not feel where a tool is that the picture does not show.
TEST(ExerciseStep, SaysWhichWayAToolWentThatIsNotSeen) {
  for (const Held held : {Held::Probe, Held::Guide}) {
    EXPECT_EQ(way_back({0, 0, 9}, held), "");
    EXPECT_EQ(way_back({8, -1, 20}, held), "") << "beside the plate";
    EXPECT_EQ(way_back({1, 1, 11.5}, held), "") << "on the plate, as well as that is known";
    EXPECT_EQ(way_back({1, 1, 20}, held), "behind the bone, Q brings it back");
    EXPECT_EQ(way_back({40, 5, 15}, held), "right of the picture, A brings it back");
    EXPECT_EQ(way_back({-40, 5, 15}, held), "left of the picture, D brings it back");
    EXPECT_EQ(way_back({5, 40, 15}, held), "below the picture, W brings it back");
    EXPECT_EQ(way_back({5, -400, 15}, held), "above the picture, S brings it back");
    EXPECT_EQ(way_back({3, 3, -4}, held), "beside the lens, E brings it back");
  }
}

// The picture's up is not the bullseye's: which way a key pushes is said in the words of the bone.
TEST(WaysOfKeys, AreNamedByTheBonesAxes) {
  simulator::HandState hand;
  landmarks::AnatomicalAxes axes;  // of a right knee in the scanner: anterior -y, proximal z, lateral -x
  EXPECT_EQ(ways_of_keys(hand, axes), "D medial, W anterior, E proximal");
  // The scope rolled by a quarter: what is right in the picture is down in the one before.
  hand.bone_from_camera.rotation = Eigen::AngleAxisd(geometry::kPi / 2, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(ways_of_keys(hand, axes), "D posterior, W medial, E proximal");
}

}  // namespace
}  // namespace arthronaut::training
