// The calibration board in somebody's hands before the simulated scope, in air: one more frame source, moved
// by the same pushes as a tool (hand_control.h), with faults that come when it matters and with the truth of
// every frame beside it. The board is a checkerboard without end; what moves is the point of it before the
// lens, and which way it faces.
//
// A push of the scope is the board's the other way round: nothing else is in the picture. The board stays
// between 7 and 50 mm before the lens, at most 12 mm beside its axis, at most 75 degrees aslant.
#pragma once

#include <memory>

#include "navigation/simulator/hand_operation.h"

namespace arthronaut::simulator {

class HandBoard : public sources::FrameSource {
 public:
  // Of the options only camera, seed, frames_per_second and square_mm count; of the hand's all but held and
  // starts_at_dimple. Of a fault only the time can be the trigger. Throws InvalidInput without a hand and for
  // broken options.
  HandBoard(const SimulationOptions& options, HandOptions hand);
  ~HandBoard() override;
  [[nodiscard]] const sources::SourceInfo& info() const override;
  [[nodiscard]] camera::FramePtr next() override;

  // The true one, of the pictures as they are given.
  [[nodiscard]] const camera::Calibration& camera() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::simulator
