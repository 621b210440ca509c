// By what a session of an exercise is told from an operation: the name of its source.
#pragma once

#include <string_view>

namespace arthronaut::sources {

// Of the simulated arthroscope in somebody's hands, which exercises alone have. Recorded sessions hold it:
// with another name here they would be taken for operations.
inline constexpr std::string_view kExerciseSource = "simulated arthroscope, by hand";

}  // namespace arthronaut::sources
