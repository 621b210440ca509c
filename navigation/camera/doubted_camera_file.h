// The camera.json of a calibration that is not reliable: the same file, which says so ("reliable": false) and
// why ("reasons"). A file without these two has nothing said against it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "navigation/camera/camera_file.h"

namespace arthronaut::camera {

// As write_camera_file(); without reasons the very same file.
void write_doubted_camera_file(const std::filesystem::path& file, const CalibrationRecord& record,
                               const std::vector<std::string>& reasons);
// What such a file says against its calibration; empty: nothing. Throws as read_camera_file().
[[nodiscard]] std::vector<std::string> read_camera_doubts(const std::filesystem::path& file);

}  // namespace arthronaut::camera
