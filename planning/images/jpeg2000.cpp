#include "planning/images/jpeg2000.h"

#include <gdcmFragment.h>
#include <gdcmJPEG2000Codec.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>

#include <cstdint>

#include "planning/files/scalar_bytes.h"
#include "planning/geometry/error.h"

namespace arthronaut::images {

namespace {

// The codestream's first two markers (ISO/IEC 15444-1, A.4.1 and A.5.1) say its size. GDCM stops the program
// by an assertion when it differs from what was announced.
void refuse_another_size(const std::filesystem::path& file, std::string_view codestream,
                         const DicomFrame& frame, const PixelBits& bits) {
  constexpr std::size_t kHeader_bytes = 43;
  if (codestream.size() < kHeader_bytes || !codestream.starts_with("\xFF\x4F\xFF\x51"))
    throw InvalidInput(file, "pixel data", "cannot be decoded: are no JPEG 2000");
  const auto number = [&](std::size_t at) {
    return files::scalar_at<std::uint32_t>(codestream.data() + at, std::endian::big);
  };
  const auto columns = static_cast<std::int64_t>(number(8)) - number(16);
  const auto rows = static_cast<std::int64_t>(number(12)) - number(20);
  const auto components = files::scalar_at<std::uint16_t>(codestream.data() + 40, std::endian::big);
  const int depth = (static_cast<unsigned char>(codestream[42]) & 0x7F) + 1;
  if (columns != frame.columns || rows != frame.rows || components != 1 || depth > bits.allocated)
    throw InvalidInput(file, "pixel data", "are of another size than the header says");
}

}  // namespace

std::vector<char> decoded_jpeg2000(const std::filesystem::path& file, std::string_view codestream,
                                   const DicomFrame& frame, const PixelBits& bits) {
  refuse_another_size(file, codestream, frame, bits);
  // GDCM prints what it stumbles over; what matters of it becomes an exception here.
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  gdcm::Trace::DebugOff();
  gdcm::JPEG2000Codec codec;
  const unsigned dimensions[3] = {static_cast<unsigned>(frame.columns), static_cast<unsigned>(frame.rows), 1};
  codec.SetNumberOfDimensions(2);
  codec.SetDimensions(dimensions);
  codec.SetPixelFormat(gdcm::PixelFormat(1, static_cast<unsigned short>(bits.allocated),
                                         static_cast<unsigned short>(bits.stored),
                                         static_cast<unsigned short>(bits.high), bits.is_signed ? 1 : 0));
  codec.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  gdcm::Fragment fragment;
  fragment.SetByteValue(codestream.data(), gdcm::VL(static_cast<std::uint32_t>(codestream.size())));
  const gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments = gdcm::SequenceOfFragments::New();
  fragments->AddFragment(fragment);
  gdcm::DataElement packed(gdcm::Tag(0x7FE0, 0x0010)), unpacked(gdcm::Tag(0x7FE0, 0x0010));
  packed.SetVR(gdcm::VR::OW);
  packed.SetValue(*fragments);
  bool is_decoded = false;
  try {
    is_decoded = codec.Decode(packed, unpacked);
  } catch (const gdcm::Exception&) {  // told below
  }
  const gdcm::ByteValue* bytes = is_decoded ? unpacked.GetByteValue() : nullptr;
  const std::size_t expected = static_cast<std::size_t>(frame.columns) *
                               static_cast<std::size_t>(frame.rows) *
                               static_cast<std::size_t>(bits.allocated / 8);
  if (!bytes || bytes->GetLength() < expected)
    throw InvalidInput(file, "pixel data", "cannot be decoded (JPEG 2000)");
  return {bytes->GetPointer(), bytes->GetPointer() + expected};
}

}  // namespace arthronaut::images
