// A bone that the picture shows elsewhere than where it lay, or otherwise than it looked, and a medium that
// the pictures contradict, as an operation is told of it and its journal keeps it.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace arthronaut::operation {

struct SeenDrift {
  double drift_mm = 0;
  // Time of a frame: until then it was seen to lie where it lay. A control point that was set later may have
  // been set on a bone that had moved. Records of older versions do not say: of them any counts.
  std::int64_t held_until_ns = std::numeric_limits<std::int64_t>::max();
};

// "1.1000000000000001 mm, where it lay until 4000000000 ns": to the last bit, since replay rests on it.
[[nodiscard]] std::string to_text(const SeenDrift& drift);
// Also of older versions, which wrote the millimetres alone. Throws InvalidInput that names `where`.
[[nodiscard]] SeenDrift seen_drift_from_text(const std::string& text, const std::string& where);

// Whether what is seen of the bone looks as it did.
struct SeenLooks {
  bool otherwise = false;
  // With otherwise, as above.
  std::int64_t held_until_ns = std::numeric_limits<std::int64_t>::max();
};
inline constexpr std::string_view kLooksOtherwise = "otherwise", kLooksAsItDid = "as it did";

// "otherwise, as it did until 4000000000 ns", or "as it did".
[[nodiscard]] std::string to_text(const SeenLooks& looks);
// Also of older versions, which wrote "otherwise" alone. Throws InvalidInput that names `where`.
[[nodiscard]] SeenLooks seen_looks_from_text(const std::string& text, const std::string& where);

// The medium in force is contradicted from now on.
struct SeenMedium {
  // Time of a frame: what was measured in this source later was, or may have been, measured through the wrong
  // medium. -1: all of it.
  std::int64_t last_sure_ns = -1;
};

// "last sure at 4000000000 ns", or "never sure".
[[nodiscard]] std::string to_text(const SeenMedium& medium);
// Throws InvalidInput that names `where`.
[[nodiscard]] SeenMedium seen_medium_from_text(const std::string& text, const std::string& where);

}  // namespace arthronaut::operation
