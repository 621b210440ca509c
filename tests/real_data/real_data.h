// Where the real and path-traced recordings lie. They are not part of the repository: without them this suite
// is skipped and says why.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/recorded_data.h"

namespace arthronaut::real_data {

inline std::filesystem::path folder() { return test::recorded_data(); }

}  // namespace arthronaut::real_data

// Declares `variable` = folder()/relative, or skips the test with the reason.
#define ARTHRONAUT_REQUIRE_DATA(variable, relative)                                    \
  const std::filesystem::path variable = arthronaut::real_data::folder() / (relative); \
  if (!std::filesystem::exists(variable))                                              \
  GTEST_SKIP() << "needs the recorded data, which is not here: " << variable.string()  \
               << " (set ARTHRONAUT_TEST_DATA to its folder)"
