// How much room a disk has.
#pragma once

#include <cstdint>
#include <filesystem>

namespace arthronaut::files {

// What the system has for users without privileges. Throws IoError.
[[nodiscard]] std::uintmax_t free_bytes_at(const std::filesystem::path& folder);

}  // namespace arthronaut::files
