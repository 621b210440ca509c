#pragma once

#include <filesystem>

namespace arthronaut::files {

// Nothing happens when there is none. Throws IoError.
void remove_file(const std::filesystem::path& file);

}  // namespace arthronaut::files
