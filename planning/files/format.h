// Numbers in sentences.
#pragma once

#include <string>

namespace arthronaut::files {

// printf into a string, of any length.
[[nodiscard]] std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace arthronaut::files
