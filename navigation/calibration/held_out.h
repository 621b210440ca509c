// A calibration against a picture that it has not seen: the board's pose is solved, the camera is not
// touched.
#pragma once

#include "navigation/calibration/calibration.h"

namespace arthronaut::calibration {

struct HeldOut {
  double rms_px = -1;  // length of the reprojection errors; -1: no board, or no pose fits
  std::size_t corner_count = 0;
  geometry::RigidTransform camera_from_board;
};

// The lens angle is that of the picture's mark where it was found, else the calibration's reference.
[[nodiscard]] HeldOut check_held_out(const CalibrationPicture& picture,
                                     const camera::Calibration& calibration, double square_mm);

}  // namespace arthronaut::calibration
