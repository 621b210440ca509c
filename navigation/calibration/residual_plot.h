// The residuals of a calibration in one picture: where the corners miss, by how much and whether there is a
// system in it.
#pragma once

#include <filesystem>
#include <span>

#include "navigation/calibration/calibration.h"
#include "navigation/camera/frame.h"

namespace arthronaut::calibration {

// Left: every corner in the image, its residual as a line drawn 100 times too long, a colour a picture, with
// the round view, the principal point (+) and the centre of rotation (x) at lens angle 0. Right: the
// residuals about their common origin with a ring a quarter pixel. 1600 x 900 px.
[[nodiscard]] camera::Frame draw_residuals(const CalibrationSummary& summary,
                                           std::span<const CalibrationPicture> pictures);

// The same into a PNG file, atomically. Throws IoError.
void write_residual_plot(const std::filesystem::path& file, const CalibrationSummary& summary,
                         std::span<const CalibrationPicture> pictures);

}  // namespace arthronaut::calibration
