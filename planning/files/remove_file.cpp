#include "planning/files/remove_file.h"

#include "planning/geometry/error.h"

namespace arthronaut::files {

void remove_file(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error) throw IoError(file, "cannot remove: " + error.message());
}

}  // namespace arthronaut::files
