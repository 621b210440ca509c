// Numbers of a given width and byte order, from bytes that need not be aligned.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>

namespace arthronaut::files {

// Reads sizeof(T) bytes: that many must be there.
template <typename T>
[[nodiscard]] T scalar_at(const char* bytes, std::endian order) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(copy, copy + sizeof(T));
  T value;
  std::memcpy(&value, copy, sizeof(T));
  return value;
}

}  // namespace arthronaut::files
