// The calibration board in somebody's hand: where pushes take it, and that its pictures show it there.
#include "navigation/simulator/hand_board.h"

#include <gtest/gtest.h>

#include "navigation/calibration/capture_guide.h"
#include "planning/geometry/error.h"

namespace arthronaut::simulator {
namespace {

using Eigen::Vector3d;

SimulationOptions board_options() {
  SimulationOptions options;
  options.camera = standard_camera();
  options.frames_per_second = 10;
  return options;
}

// Of pictures that nobody looks at the smallest that there are.
HandOptions pushing(const HandInput& input, const std::shared_ptr<HandLog>& log) {
  HandOptions options;
  options.picture_share = 0.2;
  options.hand = [input](const HandScene&, const HandState&) { return std::optional(input); };
  options.log = log;
  return options;
}

// The truth of the first frame and after so many frames of a push.
struct Pushed {
  HandTruth before, after;
};
Pushed pushed(const HandInput& input, int frames) {
  const auto log = std::make_shared<HandLog>();
  HandBoard board(board_options(), pushing(input, log));
  for (int i = 0; i < frames; ++i) (void)board.next();
  return {*log->at(0), *log->newest()};
}

double aslant_deg(const HandTruth& truth) {
  return geometry::deg_from_rad(geometry::angle_between_rad(
      truth.hand.camera_from_board.rotate(Vector3d::UnitZ()), -Vector3d::UnitZ()));
}

calibration::CaptureQuality quality_of(const camera::FramePtr& picture) {
  std::vector<std::uint8_t> gray;
  camera::gray_from(*picture, gray);
  const camera::GrayView view{gray.data(), picture->width, picture->height, picture->width};
  return calibration::measure_quality(view, calibration::observe_picture("", view));
}

TEST(HandBoard, GoesWhereItIsPushedAndNoFurther) {
  HandInput nearer;
  nearer.move = {0, 0, -1};
  const Pushed near = pushed(nearer, 20);
  EXPECT_DOUBLE_EQ(near.after.hand.camera_from_board.translation_mm.z(), 7);
  EXPECT_LT(near.after.hand.camera_from_board.translation_mm.z(),
            near.before.hand.camera_from_board.translation_mm.z());
  HandInput right;
  right.move = {1, 0, 0};
  const double to_right = pushed(right, 5).after.hand.camera_from_board.translation_mm.x() -
                          pushed(right, 1).after.hand.camera_from_board.translation_mm.x();
  EXPECT_GT(to_right, 1);
  right.moves_scope = true;  // the scope to the right: the board to the left
  const double to_left = pushed(right, 5).after.hand.camera_from_board.translation_mm.x() -
                         pushed(right, 1).after.hand.camera_from_board.translation_mm.x();
  EXPECT_NEAR(to_left, -to_right, 1e-9);
}

TEST(HandBoard, TiltsToTheSideThatIsPushedAndNeverTurnsItsBack) {
  HandInput tilt;
  tilt.tilt = {1, 0, 0};
  EXPECT_GT(pushed(tilt, 5).after.hand.camera_from_board.rotate(Vector3d::UnitZ()).x(), 0.05);
  EXPECT_LE(aslant_deg(pushed(tilt, 30).after), 75.001);
  HandInput roll;
  roll.tilt = {0, 0, 1};
  EXPECT_NEAR(aslant_deg(pushed(roll, 10).after), 0, 1e-6);
}

// The lens turns in the head: the mark goes round, the board stays.
TEST(HandBoard, TurnsTheLens) {
  HandInput lens;
  lens.turn_lens = 1;
  const Pushed turned = pushed(lens, 11);
  EXPECT_NEAR(std::remainder(turned.after.hand.mark_angle_deg - turned.before.hand.mark_angle_deg, 360), 57,
              6);  // a second at 60 degrees a second, less what it takes to begin
  EXPECT_EQ(turned.after.hand.camera_from_board.translation_mm,
            turned.before.hand.camera_from_board.translation_mm);
}

// What is true of it is what the calibration sees in the picture: its tilt, within 3 degrees.
TEST(HandBoard, IsSeenWhereItIs) {
  const auto log = std::make_shared<HandLog>();
  HandInput tilt;
  tilt.tilt = {0.6, 0, 0};
  tilt.move = {0, 0, -0.4};
  HandOptions hand = pushing(tilt, log);
  hand.picture_share = 0.5;
  HandBoard board(board_options(), hand);
  camera::FramePtr picture;
  for (int i = 0; i < 10; ++i) picture = board.next();
  const calibration::CaptureQuality quality = quality_of(picture);
  ASSERT_TRUE(quality.tilt_deg);
  EXPECT_GT(aslant_deg(*log->newest()), 15);
  EXPECT_NEAR(*quality.tilt_deg, aslant_deg(*log->newest()), 3);
}

// Fog makes edges wider than a calibration takes, and clears; a board that slips stays where it slipped to.
TEST(HandBoard, FaultsComeInTheirTime) {
  const double limit_px = calibration::CaptureLimits().widest_edge_px;
  const auto log = std::make_shared<HandLog>();
  HandOptions hand = pushing({}, log);
  hand.picture_share = 0.5;
  hand.faults = {{FaultKind::FoggedLens, Fault::Trigger::AtTime, 0, 3.05, 0.7},
                 {FaultKind::SlippedBoard, Fault::Trigger::AtTime, 3.55, 0, 30}};
  HandBoard board(board_options(), hand);
  for (int frame = 1; frame <= 36; ++frame) {
    const camera::FramePtr picture = board.next();
    const HandTruth truth = *log->newest();
    if (frame == 15) {
      EXPECT_TRUE(truth.has(FaultKind::FoggedLens));
      const calibration::CaptureQuality quality = quality_of(picture);
      EXPECT_TRUE(quality.corner_count == 0 || quality.edge_width_px > limit_px) << quality.edge_width_px;
    }
    if (frame == 32) {
      EXPECT_EQ(truth.faults, 0U);
      const calibration::CaptureQuality quality = quality_of(picture);
      EXPECT_GT(quality.corner_count, 0U);
      EXPECT_LT(quality.edge_width_px, limit_px);
      EXPECT_NEAR(aslant_deg(truth), 0, 1e-6);
    }
  }
  EXPECT_TRUE(log->newest()->has(FaultKind::SlippedBoard));
  EXPECT_NEAR(aslant_deg(*log->newest()), 30, 1e-6);
}

TEST(HandBoard, RefusesWhatIsBroken) {
  EXPECT_THROW(HandBoard(board_options(), HandOptions()), InvalidInput);
  SimulationOptions options = board_options();
  options.square_mm = 0;
  EXPECT_THROW(HandBoard(options, pushing({}, nullptr)), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::simulator
