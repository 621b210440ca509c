#include "planning/files/folded_text.h"

namespace arthronaut::files {

namespace {

// What U+00C0 to U+017F are without accents: a capital stands for two letters, a point for what is no letter.
constexpr std::string_view kBases =
    "aaaaaaAceeeeiiiidnooooo.ouuuuyTSaaaaaaAceeeeiiiidnooooo.ouuuuyTy"
    "aaaaaaccccccccddddeeeeeeeeeegggggggghhhhiiiiiiiiiiJJjjkkkllllllllllnnnnnnnnnooooooOOrrrrrrssssssss"
    "ttttttuuuuuuuuuuuuwwyyyzzzzzzs";
static_assert(kBases.size() == 192);

}  // namespace

std::string folded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
    if (byte >= 'A' && byte <= 'Z') {
      result += static_cast<char>(byte + 32);
    } else if (byte >= 0xC3 && byte <= 0xC5 && next >= 0x80 && next <= 0xBF) {
      const char base = kBases[(byte - 0xC3U) * 64U + (next - 0x80U)];
      const std::string_view both = base == 'A'   ? "ae"
                                    : base == 'S' ? "ss"
                                    : base == 'T' ? "th"
                                    : base == 'O' ? "oe"
                                                  : "ij";
      if (base == '.')
        result += text.substr(i, 2);
      else
        result += base >= 'a' ? std::string_view(&base, 1) : both;
      ++i;
    } else if ((byte == 0xCC && next >= 0x80) || (byte == 0xCD && next >= 0x80 && next <= 0xAF)) {
      ++i;  // an accent of its own, behind its letter
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace arthronaut::files
