// Decoding of one still picture straight into a frame's memory.
#pragma once

#include <filesystem>

#include "navigation/camera/frame.h"

namespace arthronaut::sources {

// As read_picture(), with index and timestamp left to the caller.
void read_picture_into(const std::filesystem::path& file, camera::Frame& frame);

}  // namespace arthronaut::sources
