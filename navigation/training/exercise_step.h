// What the trainee does next. An exercise that is a part of an operation, or none, has steps of its own: what
// the operation would ask for next is not asked there.
#pragma once

#include <string>

#include "navigation/operation/operation_state.h"
#include "navigation/simulator/hand_control.h"
#include "navigation/training/exercise.h"

namespace arthronaut::training {

// "follow the bullseye; on the plan: Enter, done". Empty: what the operation asks for is asked. Pure.
[[nodiscard]] std::string exercise_step(Goal goal, const operation::OperationState& state,
                                        const simulator::HandState& hand);

}  // namespace arthronaut::training
