// The bytes of a message, written or read one value after another: describe() of import_messages.cpp is the
// one list of what a message holds. Inner header of import.
#pragma once

#include <cstring>
#include <string>
#include <string_view>

#include "planning/geometry/error.h"

namespace arthronaut::importing {

class Writer {
 public:
  static constexpr bool kReads = false;
  void bytes(const void* from, std::size_t count) { text_.append(static_cast<const char*>(from), count); }
  // Of a list; writes it.
  std::size_t count(std::size_t count, std::size_t) {
    bytes(&count, sizeof(count));
    return count;
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

class Reader {
 public:
  static constexpr bool kReads = true;
  explicit Reader(std::string_view text) : text_(text) {}
  void bytes(void* to, std::size_t count) {
    if (text_.size() < count) throw InvalidInput("the importing process sent a message that is cut off");
    if (count > 0) std::memcpy(to, text_.data(), count);
    text_.remove_prefix(count);
  }
  void refuse_rest() const {
    if (!text_.empty()) throw InvalidInput("the importing process sent a message with something behind it");
  }
  // Refuses what the rest of the message cannot hold, before it is allocated.
  std::size_t count(std::size_t, std::size_t least_bytes_each) {
    std::size_t count = 0;
    bytes(&count, sizeof(count));
    if (count > text_.size() / least_bytes_each)
      throw InvalidInput("the importing process sent a message that is cut off");
    return count;
  }

 private:
  std::string_view text_;
};

}  // namespace arthronaut::importing
