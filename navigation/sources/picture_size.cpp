#include "navigation/sources/picture_size.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <string_view>

namespace arthronaut::sources {
namespace {

using Bytes = std::span<const std::uint8_t>;
using Size = std::optional<PictureSize>;

bool has_at(Bytes bytes, std::size_t at, std::string_view text) {
  if (bytes.size() < at || bytes.size() - at < text.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (bytes[at + i] != static_cast<std::uint8_t>(text[i])) return false;
  }
  return true;
}

// Beyond the end everything is 0: a size of 0 is refused by whoever asks.
std::uint64_t number_at(Bytes bytes, std::size_t at, int length, bool big_endian) {
  std::uint64_t value = 0;
  for (int i = 0; i < length; ++i) {
    const std::size_t where = at + static_cast<std::size_t>(big_endian ? i : length - 1 - i);
    value = (value << 8) | (where < bytes.size() ? bytes[where] : 0U);
  }
  return value;
}

// The first frame header among the segments.
Size jpeg_size(Bytes bytes) {
  std::size_t at = 2;
  while (at + 9 <= bytes.size()) {
    if (bytes[at] != 0xFF) return std::nullopt;
    const int marker = bytes[at + 1];
    if (marker == 0xFF) {  // fill
      ++at;
      continue;
    }
    const bool is_alone = marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
    const bool is_frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame) return PictureSize{number_at(bytes, at + 7, 2, true), number_at(bytes, at + 5, 2, true)};
    if (marker == 0xDA || marker == 0xD9) return std::nullopt;
    at += 2 + (is_alone ? 0 : static_cast<std::size_t>(number_at(bytes, at + 2, 2, true)));
  }
  return std::nullopt;
}

// A height below 0 means rows from above.
Size bmp_size(Bytes bytes) {
  if (number_at(bytes, 14, 4, false) == 12)
    return PictureSize{number_at(bytes, 18, 2, false), number_at(bytes, 20, 2, false)};
  const auto height = static_cast<std::int32_t>(number_at(bytes, 22, 4, false));
  return PictureSize{number_at(bytes, 18, 4, false),
                     static_cast<std::uint64_t>(std::llabs(static_cast<long long>(height)))};
}

// The largest of all directories: which of them is decoded is the decoder's choice.
Size tiff_size(Bytes bytes) {
  const bool big_endian = bytes[0] == 'M';
  std::uint64_t directory = number_at(bytes, 4, 4, big_endian);
  PictureSize largest;
  for (int page = 0; page < 64 && directory != 0 && directory + 2 <= bytes.size(); ++page) {
    const std::uint64_t count = number_at(bytes, directory, 2, big_endian);
    PictureSize size;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::size_t entry = directory + 2 + 12 * i;
      if (entry + 12 > bytes.size()) return std::nullopt;
      const std::uint64_t tag = number_at(bytes, entry, 2, big_endian);
      const bool is_short = number_at(bytes, entry + 2, 2, big_endian) == 3;
      const std::uint64_t value = number_at(bytes, entry + 8, is_short ? 2 : 4, big_endian);
      if (tag == 256) size.width = value;
      if (tag == 257) size.height = value;
    }
    largest.width = std::max(largest.width, size.width);
    largest.height = std::max(largest.height, size.height);
    directory = number_at(bytes, directory + 2 + 12 * count, 4, big_endian);
  }
  return largest;
}

Size webp_size(Bytes bytes) {
  if (has_at(bytes, 12, "VP8X"))
    return PictureSize{number_at(bytes, 24, 3, false) + 1, number_at(bytes, 27, 3, false) + 1};
  if (has_at(bytes, 12, "VP8L")) {
    const std::uint64_t bits = number_at(bytes, 21, 4, false);
    return PictureSize{(bits & 0x3FFF) + 1, ((bits >> 14) & 0x3FFF) + 1};
  }
  if (has_at(bytes, 12, "VP8 "))
    return PictureSize{number_at(bytes, 26, 2, false) & 0x3FFF, number_at(bytes, 28, 2, false) & 0x3FFF};
  return std::nullopt;
}

// "P6 # comment\n640 480 255\n".
Size pnm_size(Bytes bytes) {
  std::size_t at = 2;
  std::array<std::uint64_t, 2> numbers{};
  for (std::uint64_t& number : numbers) {
    while (at < bytes.size() && !std::isdigit(bytes[at])) {
      if (bytes[at] == '#') {
        while (at < bytes.size() && bytes[at] != '\n') ++at;
      } else if (!std::isspace(bytes[at])) {
        return std::nullopt;
      } else {
        ++at;
      }
    }
    if (at == bytes.size()) return std::nullopt;
    for (; at < bytes.size() && std::isdigit(bytes[at]); ++at) {
      number = 10 * number + static_cast<std::uint64_t>(bytes[at] - '0');
      if (number > 0xFFFFFFFF) return PictureSize{number, number};
    }
  }
  return PictureSize{numbers[0], numbers[1]};
}

}  // namespace

std::optional<PictureFormat> picture_format(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 8) return std::nullopt;
  if (has_at(bytes, 0, "\x89PNG\r\n\x1a\n") && has_at(bytes, 12, "IHDR")) return PictureFormat::Png;
  if (bytes[0] == 0xFF && bytes[1] == 0xD8) return PictureFormat::Jpeg;
  if (has_at(bytes, 0, "BM")) return PictureFormat::Bmp;
  if (has_at(bytes, 0, std::string_view("II*\0", 4)) || has_at(bytes, 0, std::string_view("MM\0*", 4)))
    return PictureFormat::Tiff;
  if (has_at(bytes, 0, "RIFF") && has_at(bytes, 8, "WEBP")) return PictureFormat::WebP;
  if (bytes[0] != 'P') return std::nullopt;
  switch (bytes[1]) {
    case '1':
    case '4':
      return PictureFormat::Pbm;
    case '2':
    case '5':
      return PictureFormat::Pgm;
    case '3':
    case '6':
      return PictureFormat::Ppm;
    default:
      return std::nullopt;
  }
}

std::optional<PictureSize> picture_size(std::span<const std::uint8_t> bytes) {
  const std::optional<PictureFormat> format = picture_format(bytes);
  if (!format) return std::nullopt;
  switch (*format) {
    case PictureFormat::Png:
      return PictureSize{number_at(bytes, 16, 4, true), number_at(bytes, 20, 4, true)};
    case PictureFormat::Jpeg:
      return jpeg_size(bytes);
    case PictureFormat::Bmp:
      return bmp_size(bytes);
    case PictureFormat::Tiff:
      return tiff_size(bytes);
    case PictureFormat::WebP:
      return webp_size(bytes);
    case PictureFormat::Pbm:
    case PictureFormat::Pgm:
    case PictureFormat::Ppm:
      return pnm_size(bytes);
  }
  return std::nullopt;
}

}  // namespace arthronaut::sources
