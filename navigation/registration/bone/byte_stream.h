// Plain values as bytes in memory and back, as this machine lays them out: for caches, which no other machine
// reads.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "planning/geometry/error.h"

namespace arthronaut::registration {

class ByteWriter {
 public:
  template <typename Value>
  void write(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <typename Value>
  void write(const std::vector<Value>& values) {
    static_assert(std::is_trivially_copyable_v<Value>);
    write(static_cast<std::uint64_t>(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// Throws InvalidInput where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <typename Value>
  [[nodiscard]] Value read() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value;
    std::memcpy(&value, take(1, sizeof value), sizeof value);
    return value;
  }
  template <typename Value>
  [[nodiscard]] std::vector<Value> read_many() {
    static_assert(std::is_trivially_copyable_v<Value>);
    const auto count = read<std::uint64_t>();
    const char* first = take(count, sizeof(Value));
    std::vector<Value> values(count);
    if (count > 0) std::memcpy(static_cast<void*>(values.data()), first, count * sizeof(Value));
    return values;
  }
  [[nodiscard]] std::string_view rest() const { return bytes_; }

 private:
  const char* take(std::uint64_t count, std::size_t size) {
    if (count > bytes_.size() / size) throw InvalidInput("the bytes end too early");
    const char* first = bytes_.data();
    bytes_.remove_prefix(count * size);
    return first;
  }

  std::string_view bytes_;
};

// 64 bits that differ when the bytes do, but for chance; no protection against design.
[[nodiscard]] inline std::uint64_t hash_of(std::string_view bytes, std::uint64_t seed = 0) {
  constexpr std::uint64_t kMultiplier = 0x9e3779b97f4a7c15ULL;
  std::uint64_t hash = seed ^ (bytes.size() * kMultiplier);
  const auto mix = [&hash](std::uint64_t word) {
    hash = (hash ^ word) * kMultiplier;
    hash ^= hash >> 29;
  };
  std::uint64_t word = 0;
  for (; bytes.size() >= sizeof word; bytes.remove_prefix(sizeof word)) {
    std::memcpy(&word, bytes.data(), sizeof word);
    mix(word);
  }
  word = 0;
  std::memcpy(&word, bytes.data(), bytes.size());
  mix(word);
  return hash;
}

}  // namespace arthronaut::registration
