#include "navigation/training/exercise_step.h"

namespace arthronaut::training {

std::string exercise_step(Goal goal, const operation::OperationState& state,
                          const simulator::HandState& hand) {
  const bool holds_probe = hand.held == simulator::Held::Probe;
  switch (goal) {
    case Goal::Calibrate:
      return "";
    case Goal::Pivot:
      if (!holds_probe) return "take the probe: G";
      return hand.touches_bone ? "tilt the handle to all sides, then Enter: done"
                               : "set the probe's tip on the bone";
    case Goal::Aim:
      if (holds_probe) return "take the guide: G";
      if (state.frame.guidance.state == guidance::GuidanceState::WorldMarkerLost)
        return "bring the bone's marker into view";
      return state.guided_lately ? "follow the bullseye; on the plan: Enter, done"
                                 : "bring the guide into view";
    case Goal::Register:
      return state.verification == operation::Verification::ByTouches ? "verified: Enter, done" : "";
    case Goal::Drill:
      return state.drilled.outcome == operation::DrilledState::Outcome::Recorded ? "drilled: Enter, done"
                                                                                 : "";
  }
  return "";
}

}  // namespace arthronaut::training
