#include "planning/files/unit_signs.h"

#include <cctype>
#include <string_view>

namespace arthronaut::files {

namespace {

// Whole words alone: none that goes on in letters or digits, before or behind.
void put_for(std::string& text, std::string_view word, std::string_view sign) {
  const auto is_of_word = [&](std::size_t at) {
    return at < text.size() && std::isalnum(static_cast<unsigned char>(text[at])) != 0;
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at)) {
    const bool begins = word.front() == ' ' || at == 0 || !is_of_word(at - 1);
    if (begins && !is_of_word(at + word.size())) text.replace(at, word.size(), sign);
    at += sign.size();
  }
}

}  // namespace

std::string with_signs(std::string plain) {
  put_for(plain, " deg", "\u00b0");
  put_for(plain, "mm2", "mm\u00b2");
  put_for(plain, "+-", "\u00b1");
  return plain;
}

}  // namespace arthronaut::files
