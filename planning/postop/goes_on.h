// How a search that takes seconds is followed and ended.
#pragma once

#include <functional>

namespace arthronaut::postop {

// Told how much is done, 0 to 1, many times a second; false ends it. May be empty.
using GoesOn = std::function<bool(double share)>;

}  // namespace arthronaut::postop
