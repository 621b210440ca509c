#include "planning/geometry/error.h"

#include <array>
#include <cstdio>

namespace arthronaut {

namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

// U+0080 to U+009F in UTF-8, some of which a terminal obeys.
bool is_high_control(const std::string& text, std::size_t at) {
  return text[at] == '\xc2' && at + 1 < text.size() && static_cast<unsigned char>(text[at + 1]) >= 0x80 &&
         static_cast<unsigned char>(text[at + 1]) < 0xa0;
}

std::string one_line(const std::string& message) {
  std::string line;
  for (std::size_t i = 0; i < message.size(); ++i) {
    const char c = message[i];
    if (is_high_control(message, i)) {
      std::array<char, 7> code{};
      (void)std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned char>(message[++i]));
      line += code.data();
    } else if (!is_control(c)) {
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
