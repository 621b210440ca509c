#include "planning/files/free_space.h"

#include "planning/geometry/error.h"

namespace arthronaut::files {

std::uintmax_t free_bytes_at(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (error) throw IoError(folder, "cannot tell how much room its disk has: " + error.message());
  return space.available;
}

}  // namespace arthronaut::files
