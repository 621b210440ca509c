// Pipes in a file's place.
#pragma once

#include <filesystem>

#include "planning/geometry/error.h"

namespace arthronaut::files {

// Throws IoError for a pipe, into which nobody may ever write: a reader would wait without end. What a shell
// puts in a file's place, under /dev, has its writer.
inline void refuse_pipe(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_fifo(file, ignored) && !file.string().starts_with("/dev/"))
    throw IoError(file, "is a pipe, not a file");
}

}  // namespace arthronaut::files
