#include "planning/geometry/error.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace arthronaut {

namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

std::string one_line(const std::string& message) {
  if (std::none_of(message.begin(), message.end(), is_control)) return message;
  std::string line;
  for (const char c : message) {
    if (!is_control(c)) {
      line += c;
    } else if (c == '\n') {
      line += "\\n";
    } else if (c == '\r') {
      line += "\\r";
    } else if (c == '\t') {
      line += "\\t";
    } else {
      std::array<char, 5> code{};
      (void)std::snprintf(code.data(), code.size(), "\\x%02x", static_cast<unsigned>(c));
      line += code.data();
    }
  }
  return line;
}

std::string in_file(const std::filesystem::path& file, const std::string& place, const std::string& reason) {
  return file.string() + ": " + (place.empty() ? "" : place + ": ") + reason;
}

}  // namespace

InvalidInput::InvalidInput(const std::string& message) : std::runtime_error(one_line(message)) {}

InvalidInput::InvalidInput(const std::filesystem::path& file, const std::string& place,
                           const std::string& reason)
    : std::runtime_error(one_line(in_file(file, place, reason))) {}

IoError::IoError(const std::string& message) : std::runtime_error(one_line(message)) {}

IoError::IoError(const std::filesystem::path& file, const std::string& reason)
    : std::runtime_error(one_line(in_file(file, "", reason))) {}

DeviceError::DeviceError(const std::string& message) : std::runtime_error(one_line(message)) {}

}  // namespace arthronaut
