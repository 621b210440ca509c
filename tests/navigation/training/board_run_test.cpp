// The calibration of a camera as an exercise.
#include "navigation/training/board_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "navigation/training/trainee.h"
#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::training {
namespace {

using simulator::HandInput;
using simulator::HandScene;
using simulator::HandState;
using simulator::Press;
using ::testing::HasSubstr;

const Exercise& calibrating() { return *find_exercise("calibrate"); }
ExerciseSetup setup_at(Level level) { return standard_setup(calibrating(), level, 1); }

const ExerciseOutcome& careful_run() {
  static const ExerciseOutcome outcome =
      run_exercise(setup_at(Level::Easy), make_trainee(Goal::Calibrate, careful(1)));
  return outcome;
}

const ExerciseOutcome& hasty_run() {
  static const ExerciseOutcome outcome =
      run_exercise(setup_at(Level::Easy), make_trainee(Goal::Calibrate, hasty(1)));
  return outcome;
}

// Pushes the same in each of so many frames, and presses at the last.
simulator::Hand holding(int frames, const HandInput& input, Press at_last) {
  return [=, frame = 0](const HandScene&, const HandState&) mutable -> std::optional<HandInput> {
    if (frame++ >= frames) return std::nullopt;
    HandInput pushed = input;
    pushed.held = simulator::Held::Board;
    if (frame == frames) pushed.press = at_last;
    return pushed;
  };
}

// Centre and principal point moved alike: every pixel of every lens angle is off by just that.
TEST(ErrorOverView, IsTheShiftOfTheWholeView) {
  const camera::Calibration truth = simulator::standard_camera();
  EXPECT_NEAR(error_over_view_px(truth, truth), 0, 1e-9);
  camera::Calibration found = truth;
  found.principal_point_px += Eigen::Vector2d(0.3, -0.4);
  found.rotation_center_px += Eigen::Vector2d(0.3, -0.4);
  EXPECT_NEAR(error_over_view_px(found, truth), 0.5, 1e-9);
}

// A focal length that is 1 % off moves a pixel by 1 % of its distance from the principal point. In the root
// mean square over a disc of radius R whose middle is d from it that is sqrt(R^2 / 2 + d^2); the grid of the
// view is coarse.
TEST(ErrorOverView, GrowsOutwardsWithTheFocalLength) {
  const camera::Calibration truth = simulator::standard_camera();
  camera::Calibration found = truth;
  found.focal_px *= 1.01;
  const double radius = truth.boundary.radius_px;
  const double beside = (truth.boundary.center_px - truth.principal_point_px).norm();
  EXPECT_NEAR(error_over_view_px(found, truth), 0.01 * std::sqrt(radius * radius / 2 + beside * beside),
              0.05);
}

// The same camera told from another angle of its lens.
TEST(ErrorOverView, DoesNotMindFromWhichAngleTheLensIsCounted) {
  const camera::Calibration truth = simulator::standard_camera();
  camera::Calibration found = truth;
  found.reference_mark_angle_deg = std::fmod(truth.reference_mark_angle_deg + 70, 360);
  const double turned = truth.lens_angle_rad(found.reference_mark_angle_deg);
  found.principal_point_px = truth.turned(truth.principal_point_px, turned);
  EXPECT_NEAR(error_over_view_px(found, truth), 0, 1e-6);
}

// Good pictures from all sides make a camera that the program would adopt.
TEST(BoardRun, TheCarefulTraineeFindsTheCamera) {
  const ExerciseFacts& facts = careful_run().facts;
  EXPECT_TRUE(facts.is_done);
  EXPECT_EQ(facts.coverage.size(), 5U);
  EXPECT_EQ(facts.refused_pictures, 0);
  ASSERT_TRUE(facts.camera_error_px) << facts.camera_trouble;
  EXPECT_LT(*facts.camera_error_px, 1);
  EXPECT_TRUE(careful_run().score.session.empty());
}

// Lens turned by 25 degrees, the board never at rest: the guide refuses, and each refusal counts.
TEST(BoardRun, HasteIsRefusedAndCosts) {
  const ExerciseOutcome& hurried = hasty_run();
  EXPECT_EQ(static_cast<int>(hurried.facts.coverage.size()) + hurried.facts.refused_pictures, 4);
  EXPECT_GT(hurried.facts.refused_pictures, 0);
  EXPECT_LT(hurried.score.points, careful_run().score.points - 20);
  EXPECT_FALSE(hurried.score.better.empty());
}

// What was kept of the hand gives the same pictures, and so the same of everything to the last bit.
TEST(BoardRun, KeptHandDoesTheSame) {
  const test::TemporaryFolder folder;
  write_hand_file(folder / "hand.json", hasty_run().frames);
  const ExerciseOutcome again = run_exercise(setup_at(Level::Easy), read_hand_file(folder / "hand.json"));
  EXPECT_EQ(again.facts.frames, hasty_run().facts.frames);
  EXPECT_EQ(again.facts.coverage, hasty_run().facts.coverage);
  EXPECT_EQ(again.facts.refused_pictures, hasty_run().facts.refused_pictures);
  EXPECT_EQ(again.facts.camera_error_px, hasty_run().facts.camera_error_px);
  EXPECT_EQ(again.score.points, hasty_run().score.points);
}

// Too aslant to see enough of it: refused with the reason, and nothing is found.
TEST(BoardRun, ABoardTooFarAslantIsRefused) {
  HandInput aslant;
  aslant.tilt = {1, 0, 0};
  BoardRun run(setup_at(Level::Easy), holding(30, aslant, Press::Picture), false);
  while (run.step()) {
  }
  EXPECT_TRUE(run.facts().coverage.empty());
  EXPECT_EQ(run.facts().refused_pictures, 1);
  EXPECT_THAT(run.status().note, HasSubstr("Not taken"));
  EXPECT_FALSE(run.facts().is_done);
}

// A picture that was dropped counts neither way.
TEST(BoardRun, ADroppedPictureIsForgotten) {
  simulator::Hand hand = [frame = 0](const HandScene&, const HandState&) mutable -> std::optional<HandInput> {
    HandInput input;
    input.held = simulator::Held::Board;
    if (frame == 8) input.press = Press::Picture;
    if (frame == 9) input.press = Press::DropPicture;
    return ++frame > 10 ? std::nullopt : std::optional(input);
  };
  BoardRun run(setup_at(Level::Easy), hand, false);
  std::size_t most = 0;
  while (run.step()) most = std::max(most, run.facts().coverage.size());
  EXPECT_EQ(most, 1U);
  EXPECT_TRUE(run.facts().coverage.empty());
  EXPECT_EQ(run.facts().refused_pictures, 0);
}

// Who says "done" without pictures is done, has found nothing, and earns nothing but for the time, if that.
TEST(BoardRun, DoneWithoutPicturesIsWorthNothing) {
  const ExerciseOutcome nothing = run_exercise(setup_at(Level::Easy), holding(3, {}, Press::Finish));
  EXPECT_TRUE(nothing.facts.is_done);
  EXPECT_FALSE(nothing.facts.camera_error_px);
  EXPECT_FALSE(nothing.facts.camera_trouble.empty());
  EXPECT_LE(nothing.score.points, 20);
}

// A calibration is no operation.
TEST(BoardRun, LeavesNoSession) {
  const test::TemporaryFolder folder;
  theatre::RecordOptions record;
  record.folder = folder / "session";
  EXPECT_THROW((void)run_exercise(setup_at(Level::Easy), holding(3, {}, Press::Finish), record),
               InvalidInput);
  EXPECT_FALSE(std::filesystem::exists(record.folder));
}

}  // namespace
}  // namespace arthronaut::training
