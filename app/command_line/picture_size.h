// Pictures of another size than the camera was calibrated for are told with the file's name, before any work.
#pragma once

#include <string>

#include "navigation/camera/camera_model.h"
#include "navigation/sources/frame_source.h"

namespace arthronaut::command_line {

// Throws InvalidInput: file, place and both sizes. A live source may change its size, and is watched instead.
void refuse_other_size(const std::string& video, const sources::FrameSource& source,
                       const camera::Calibration& calibration);

}  // namespace arthronaut::command_line
