#include "tests/fuzzing/reader.h"

#include <fstream>
#include <iterator>

namespace arthronaut::fuzzing {

std::filesystem::path put(const std::filesystem::path& folder, std::string_view name,
                          std::string_view bytes) {
  const std::filesystem::path file = folder / name;
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

std::string taken(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace arthronaut::fuzzing
