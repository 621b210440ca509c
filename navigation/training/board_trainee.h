// The trainee made of numbers with the calibration board in its hand. Inner header of training: see
// make_trainee().
#pragma once

#include "navigation/training/trainee.h"

namespace arthronaut::training {

[[nodiscard]] simulator::Hand make_board_trainee(const Skill& skill);

}  // namespace arthronaut::training
