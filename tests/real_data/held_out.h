// A calibration against a picture that it has not seen: the board's pose is solved, the camera is not
// touched.
#pragma once

#include "navigation/calibration/calibration.h"

namespace arthronaut::calibration {

struct HeldOut {
  // Length of the reprojection errors; -1: not measurable, as no lens mark, no board or no pose was found.
  double rms_px = -1;
  std::size_t corner_count = 0;
  geometry::RigidTransform camera_from_board;
};

// At the lens angle of the picture's mark.
[[nodiscard]] HeldOut check_held_out(const CalibrationPicture& picture,
                                     const camera::Calibration& calibration, double square_mm);

}  // namespace arthronaut::calibration
