#include "navigation/simulator/script.h"

#include <gtest/gtest.h>

#include "tests/navigation/simulator/phantom_options.h"

namespace arthronaut::simulator {
namespace {

// One stage for all tests: it takes a while to find.
class ScriptTest : public ::testing::Test {
 protected:
  struct Scene {
    SimulationOptions options = phantom_options();
    geometry::Surface bone{options.knee.femur.mesh};
    Staging staging = stage_operation(options, bone);
  };
  static const Scene& scene() {
    static const Scene only;
    return only;
  }
  const SimulationOptions& options_ = scene().options;
  const geometry::Surface& bone_ = scene().bone;
  const Staging& staging_ = scene().staging;
  Eigen::Vector3d tip_in_probe_ = *probe_of(options_.tools).tip_mm;
};

// The probe's tip rests in its dimple through the whole swing.
TEST_F(ScriptTest, PivotKeepsTheTip) {
  const Script script = pivot_script(options_, staging_);
  EXPECT_GE(script.size(), 100u);
  const Eigen::Vector3d dimple = staging_.pivot.front().tip_mm;
  EXPECT_LT(std::abs(bone_.signed_distance_mm(dimple)), 1e-6);
  for (const Moment& moment : script) {
    EXPECT_LT((*moment.bone_from_probe * tip_in_probe_ - dimple).norm(), 1e-9);
  }
}

// The tip is on the bone wherever the truth says so, and moves no faster than a hand: 40 mm/s.
TEST_F(ScriptTest, ScratchStaysOnTheBone) {
  const Script script = scratch_script(options_, staging_);
  int touching = 0;
  for (std::size_t i = 0; i < script.size(); ++i) {
    if (!script[i].tip_touches_bone) continue;
    ++touching;
    const Eigen::Vector3d tip = *script[i].bone_from_probe * tip_in_probe_;
    EXPECT_LT(std::abs(bone_.signed_distance_mm(tip)), 1e-3);
    if (i > 0 && script[i - 1].tip_touches_bone) {
      const double step_mm = (tip - *script[i - 1].bone_from_probe * tip_in_probe_).norm();
      EXPECT_LE(step_mm * options_.frames_per_second, 40);
    }
  }
  EXPECT_GE(touching, 180);
}

// After the strokes the tip rests where it was asked to: for more than the quarter of a second that a touch
// takes, on the bone, at places of their own (3 mm apart), and at the first one once more; the strokes before
// are the same as without.
TEST_F(ScriptTest, ScratchRestsAtPlacesToTouch) {
  const Script strokes = scratch_script(options_, staging_);
  SimulationOptions resting = options_;
  resting.rest_count = 4;
  const Script script = scratch_script(resting, staging_);
  ASSERT_GT(script.size(), strokes.size());
  std::vector<Eigen::Vector3d> places;
  int still = 0;
  for (std::size_t i = strokes.size(); i < script.size(); ++i) {
    const Eigen::Vector3d tip = *script[i].bone_from_probe * tip_in_probe_;
    const Eigen::Vector3d before = *script[i - 1].bone_from_probe * tip_in_probe_;
    still = (tip - before).norm() < 1e-9 ? still + 1 : 0;
    if (still != options_.frames_per_second / 2) continue;
    EXPECT_TRUE(script[i].tip_touches_bone);
    EXPECT_LT(std::abs(bone_.signed_distance_mm(tip)), 1e-3);
    places.push_back(tip);
  }
  ASSERT_EQ(places.size(), 5U);
  EXPECT_LT((places.front() - places.back()).norm(), 1e-9);
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_GT((places[a] - places[b]).norm(), 3);
  // Without strokes the same places, at once.
  resting.draws = false;
  const Script touching = scratch_script(resting, staging_);
  EXPECT_LT(touching.size(), script.size() - strokes.size() + 10);
  const Eigen::Vector3d first = *touching[20].bone_from_probe * tip_in_probe_;
  EXPECT_LT((first - places.front()).norm(), 1e-9);
}

// The guide ends on the line it aims at and stays there while the drill goes in.
TEST_F(ScriptTest, DrillEndsOnItsAim) {
  const auto& axis = *guide_of(options_).axis;
  const Script script = drill_script(options_, staging_, options_.plan, 30);
  const Moment& last = script.back();
  EXPECT_LT((*last.bone_from_guide * axis.point_mm - options_.plan.entry_mm).norm(), 1e-6);
  EXPECT_LT((last.bone_from_guide->rotate(axis.direction) - options_.plan.direction).norm(), 1e-6);
  EXPECT_NEAR(last.drilled_depth_mm, 30, 1e-9);
  EXPECT_EQ(script.front().drilled_depth_mm, 0);
  for (std::size_t i = 1; i < script.size(); ++i) {
    EXPECT_GE(script[i].drilled_depth_mm, script[i - 1].drilled_depth_mm);
  }
}

// The board is shown at lens angles spread over more than 100 degrees, each tilted by 25 degrees or more.
TEST_F(ScriptTest, CalibrateTurnsTheLensAndTiltsTheBoard) {
  const Script script = calibrate_script(options_);
  ASSERT_GE(script.size(), 3u);
  double least = 1e9, most = -1e9;
  for (const Moment& moment : script) {
    const double lens = geometry::deg_from_rad(options_.camera.lens_angle_rad(moment.mark_angle_deg));
    least = std::min(least, lens);
    most = std::max(most, lens);
    const Eigen::Vector3d normal = moment.camera_from_board->rotate(Eigen::Vector3d::UnitZ());
    const double tilt =
        geometry::deg_from_rad(geometry::angle_between_rad(normal, -Eigen::Vector3d::UnitZ()));
    EXPECT_GE(tilt, 24.9);
    EXPECT_LE(tilt, 35.1);
  }
  EXPECT_GT(most - least, 100);
}

}  // namespace
}  // namespace arthronaut::simulator
