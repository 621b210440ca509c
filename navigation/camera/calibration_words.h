// Which calibration it was, in one line for whoever looks at a session.
#pragma once

#include <string>

#include "navigation/camera/camera_file.h"

namespace arthronaut::camera {

// Scope and head: "Scope 3, head B"; "not recorded" where the file names neither.
[[nodiscard]] std::string scope_in_words(const CalibrationRecord& record);
// "Scope 3, calibrated 2026-02-03 10:00:00 UTC in air, RMS 0.41 px"; what is not known is said to be not
// recorded.
[[nodiscard]] std::string in_words(const CalibrationRecord& record);

}  // namespace arthronaut::camera
