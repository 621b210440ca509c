// Removing a file, with the reason where that fails.
#pragma once

#include <filesystem>

namespace arthronaut::files {

// Nothing happens when there is none. Throws IoError.
void remove_file(const std::filesystem::path& file);

}  // namespace arthronaut::files
