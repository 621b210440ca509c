// The exercise in which a camera is calibrated, without a thread: the simulated board in somebody's hand, the
// pictures that he takes of it, what the program makes of them, and the truth beside it. It is no operation:
// without a camera there is no pose, so no session is kept; what was pushed can be (write_hand_file), and
// gives the same pictures again to the last byte.
#pragma once

#include "navigation/calibration/calibrate_job.h"
#include "navigation/simulator/hand_board.h"
#include "navigation/training/exercise_run.h"

namespace arthronaut::training {

// What stands in a score in the place of the knee.
inline constexpr std::string_view kBoardAlone = "checkerboard";

class BoardRun {
 public:
  // Of the setup the exercise, level and seed count. Throws InvalidInput without a hand.
  BoardRun(const ExerciseSetup& setup, const simulator::Hand& hand, bool in_real_time);
  // One picture further, and what was pressed with it: a picture that is not good is refused and counted.
  // After "finish" the next step calibrates. False: it is over, and stays so.
  bool step();
  [[nodiscard]] calibration::CalibrateStatus status() const { return job_.status(); }
  [[nodiscard]] ExerciseFacts facts() const { return facts_; }
  [[nodiscard]] std::vector<simulator::HandTruth> frames() const { return log_->all(); }

 private:
  void press(simulator::Press press);
  void judge_camera();

  std::shared_ptr<simulator::HandLog> log_ = std::make_shared<simulator::HandLog>();
  simulator::HandBoard board_;
  calibration::CalibrateJob job_;
  ExerciseFacts facts_;
};

// How far apart two cameras put what lies in the round view, px: the root mean square over it, the lens at
// every 45 degrees. By where the mark is seen, so that from which angle either counts its lens does not
// matter. Infinite where the one found has no pixel for what is seen.
[[nodiscard]] double error_over_view_px(const camera::Calibration& found, const camera::Calibration& truth);

}  // namespace arthronaut::training
