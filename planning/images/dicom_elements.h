// The data elements of a DICOM file, strictly. Inner header of images.
//
// GDCM, as Debian builds it, stops the whole program by an assertion on many broken files, and fills up
// pixels that are cut off. So every file is walked through here first, and GDCM is left with what only it can
// do: to decompress.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace arthronaut::images {

struct DicomElements {
  std::string transfer_syntax;                  // UID
  std::endian order = std::endian::little;      // of numbers and uncompressed pixels
  std::map<std::uint32_t, std::string> values;  // group << 16 | element; the short ones of the top level
  bool has_pixel_data = false;
  bool is_compressed = false;
  std::string raw_pixels;  // when not compressed: all that the element holds

  // Without the blanks around it; empty when absent.
  [[nodiscard]] std::string text(std::uint16_t group, std::uint16_t element) const;
  [[nodiscard]] int unsigned_short(std::uint16_t group, std::uint16_t element, int absent) const;
};

[[nodiscard]] bool has_dicom_mark(std::string_view text);
// `text` is the whole file and has the mark. Throws InvalidInput with the byte at which the structure breaks.
[[nodiscard]] DicomElements parse_dicom(const std::filesystem::path& file, std::string_view text);

}  // namespace arthronaut::images
