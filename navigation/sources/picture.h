// One still picture on disk.
#pragma once

#include <filesystem>

#include "navigation/camera/frame.h"

namespace arthronaut::sources {

// As read_picture(), straight into a frame's memory, with index and timestamp left to the caller.
void read_picture_into(const std::filesystem::path& file, camera::Frame& frame);

// PNG, 8 bit, replaced in one step. Throws IoError.
void write_png(const std::filesystem::path& file, const camera::Frame& picture);

}  // namespace arthronaut::sources
