// What the trainee does next. An exercise that is a part of an operation, or none, has steps of its own: what
// the operation would ask for next is not asked there.
#pragma once

#include <string>

#include "navigation/camera/camera_model.h"
#include "navigation/operation/operation_state.h"
#include "navigation/simulator/hand_control.h"
#include "navigation/training/exercise.h"
#include "planning/geometry/surface.h"
#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::training {

// "follow the bullseye; on the plan: Enter, done". Empty: what the operation asks for is asked. Pure.
[[nodiscard]] std::string exercise_step(Goal goal, const operation::OperationState& state,
                                        const simulator::HandState& hand);

// Where the tip of what is held went when the picture does not show it, with the key that brings it back:
// "right of the picture, A brings it back". A hand feels where its tool is; keys do not. Empty: it is shown.
// lens: at the hand's mark angle. bone: in whose frame the hand's places are. Not of a board. Pure.
[[nodiscard]] std::string way_back_into_view(const simulator::HandState& hand,
                                             const camera::CameraModel& lens, const geometry::Surface& bone);

// Which way three of the keys push the tool, in the words of the bullseye, which has other directions up than
// the picture: "D lateral, W anterior, E proximal". Each by the bone's axis that it lies nearest to; of two
// keys that lie nearest to the same one both bear its name. Pure.
[[nodiscard]] std::string ways_of_keys(const simulator::HandState& hand,
                                       const landmarks::AnatomicalAxes& axes);

}  // namespace arthronaut::training
