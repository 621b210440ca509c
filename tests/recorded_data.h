// Where the real and path-traced recordings lie, for tests and benchmarks. They are not part of the
// repository.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace arthronaut::test {

// ARTHRONAUT_TEST_DATA names it; else ARTHRONAUT_TEST_DATA_DEFAULT, which the program's CMakeLists.txt
// defines.
inline std::filesystem::path recorded_data() {
  if (const char* named = std::getenv("ARTHRONAUT_TEST_DATA")) return named;
  return ARTHRONAUT_TEST_DATA_DEFAULT;
}

}  // namespace arthronaut::test
