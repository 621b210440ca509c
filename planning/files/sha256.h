// SHA-256 (FIPS 180-4) of bytes, to say of which mesh, camera or file something is.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace arthronaut::files {

// Bytes go in piece by piece, in order.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void add(std::span<const std::byte> bytes);
  // 64 lower-case hexadecimal digits. The object is used up.
  [[nodiscard]] std::string hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

[[nodiscard]] std::string sha256_of(std::string_view text);
// Throws IoError.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace arthronaut::files
