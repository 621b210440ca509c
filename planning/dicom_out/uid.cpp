#include "planning/dicom_out/uid.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>

#include "planning/files/sha256.h"

namespace arthronaut::dicom_out {

namespace {

using Words = std::array<std::uint32_t, 4>;  // of 128 bits, the highest first

// By long division, as no type holds 128 bits everywhere.
std::string decimal(Words number) {
  std::string digits;
  while (std::any_of(number.begin(), number.end(), [](std::uint32_t word) { return word != 0; })) {
    std::uint64_t rest = 0;
    for (std::uint32_t& word : number) {
      rest = (rest << 32) | word;
      word = static_cast<std::uint32_t>(rest / 10);
      rest %= 10;
    }
    digits += static_cast<char>('0' + rest);
  }
  std::reverse(digits.begin(), digits.end());
  return digits;
}

}  // namespace

std::string uid_of(std::string_view purpose, std::string_view contents) {
  // A zero byte between them: no two pairs run together to the same text.
  const std::string hash =
      files::sha256_of(std::string(purpose) + std::string(1, '\0') + std::string(contents));
  Words words{};
  for (std::size_t i = 0; i < words.size(); ++i)
    std::from_chars(hash.data() + 8 * i, hash.data() + 8 * (i + 1), words[i], 16);
  words[1] = (words[1] & 0xffff0fffU) | 0x00008000U;  // version
  words[2] = (words[2] & 0x3fffffffU) | 0x80000000U;  // variant
  return "2.25." + decimal(words);
}

bool is_uid(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return !text.empty() && text.size() <= 64 && is_digit(text.front()) && is_digit(text.back()) &&
         std::all_of(text.begin(), text.end(), [&](char c) { return is_digit(c) || c == '.'; });
}

}  // namespace arthronaut::dicom_out
