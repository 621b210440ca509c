// JPEG 2000, the one compression of DICOM that DCMTK does not read: by GDCM's codec. Inner header of images.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "planning/images/dicom_pixels.h"

namespace arthronaut::images {

// How a pixel lies in its bytes.
struct PixelBits {
  int allocated = 16, stored = 16, high = 15;
  bool is_signed = false;
};

// Pixels of bits.allocated each, in this machine's byte order. Throws InvalidInput: no codestream, or one of
// another size than `frame`; that is judged by its header, before it is unpacked.
[[nodiscard]] std::vector<char> decoded_jpeg2000(const std::filesystem::path& file,
                                                 std::string_view codestream, const DicomFrame& frame,
                                                 const PixelBits& bits);

}  // namespace arthronaut::images
