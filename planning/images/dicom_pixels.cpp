#include "planning/images/dicom_pixels.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dccodec.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dctk.h>

#include <cstdint>
#include <cstring>
#include <string_view>

#include "planning/files/scalar_bytes.h"
#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"
#include "planning/images/jpeg2000.h"

namespace arthronaut::images {

namespace {

PixelBits pixel_bits_of(const std::filesystem::path& file, DcmItem& dataset) {
  PixelBits bits;
  bits.allocated = unsigned_short_of(dataset, DCM_BitsAllocated, 16);
  bits.stored = unsigned_short_of(dataset, DCM_BitsStored, bits.allocated);
  bits.high = unsigned_short_of(dataset, DCM_HighBit, bits.stored - 1);
  bits.is_signed = unsigned_short_of(dataset, DCM_PixelRepresentation, 0) == 1;
  if ((bits.allocated != 8 && bits.allocated != 16 && bits.allocated != 32) || bits.stored < 1 ||
      bits.stored > bits.allocated || bits.high >= bits.allocated || bits.high + 1 < bits.stored) {
    throw InvalidInput(file, "pixel format", "is not one that is read");
  }
  return bits;
}

std::size_t byte_count(const DicomFrame& frame, const PixelBits& bits) {
  return static_cast<std::size_t>(frame.rows) * static_cast<std::size_t>(frame.columns) *
         static_cast<std::size_t>(bits.allocated / 8);
}

// The bits beside the stored ones may hold overlays of old scanners: cut off.
template <typename Stored>
void append_rescaled(const std::vector<char>& bytes, std::size_t count, const PixelBits& bits,
                     const DicomFrame& frame, std::vector<float>& values) {
  const auto shift = static_cast<unsigned>(bits.high + 1 - bits.stored);
  const std::uint64_t mask = (std::uint64_t{1} << static_cast<unsigned>(bits.stored)) - 1;
  const std::uint64_t sign = bits.is_signed ? (mask >> 1U) + 1 : 0;
  const std::size_t start = values.size();
  values.resize(start + count);
  for (std::size_t i = 0; i < count; ++i) {
    Stored stored;
    std::memcpy(&stored, bytes.data() + i * sizeof(Stored), sizeof(Stored));
    const std::uint64_t value = static_cast<std::uint64_t>(stored) >> shift & mask;
    // Two's complement of the stored width: flips the sign bit, then takes its weight away.
    const auto number = static_cast<std::int64_t>(value ^ sign) - static_cast<std::int64_t>(sign);
    values[start + i] = static_cast<float>(frame.slope * static_cast<double>(number) + frame.intercept);
  }
}

// The compressed frame, put together from its fragments.
std::string codestream_of(const std::filesystem::path& file, DcmDataset& dataset, DcmPixelData& pixels,
                          int frame) {
  DcmPixelSequence* fragments = nullptr;
  const E_TransferSyntax syntax = dataset.getOriginalXfer();
  if (pixels.getEncapsulatedRepresentation(syntax, nullptr, fragments).bad() || !fragments)
    throw InvalidInput(file, "pixel data", "hold no fragments");
  const auto frames = decimals_of(dataset, DCM_NumberOfFrames, 1);
  const auto frame_count = static_cast<Sint32>(frames ? frames->front() : 1);
  const auto start_of = [&](int number, Uint32& fragment) {
    return DcmCodec::determineStartFragment(static_cast<Uint32>(number), frame_count, fragments, fragment);
  };
  Uint32 begin = 0, end = static_cast<Uint32>(fragments->card());
  if (start_of(frame, begin).bad() || (frame + 1 < frame_count && start_of(frame + 1, end).bad()))
    throw InvalidInput(file, "pixel data", "do not say where each frame begins");
  std::string codestream;
  for (Uint32 i = begin; i < end; ++i) {
    DcmPixelItem* fragment = nullptr;
    Uint8* bytes = nullptr;
    if (fragments->getItem(fragment, i).bad() || fragment->getUint8Array(bytes).bad() || !bytes)
      throw InvalidInput(file, "pixel data", "end within a fragment");
    codestream.append(reinterpret_cast<const char*>(bytes), fragment->getLength());
  }
  return codestream;
}

// An RLE frame begins with the number of its segments, one a byte of a pixel, and where each lies (DICOM
// PS3.5, annex G.5). DCMTK reads beyond the frame where these are wrong.
void refuse_broken_rle(const std::filesystem::path& file, std::string_view frame, const PixelBits& bits) {
  constexpr std::size_t kHeader_bytes = 64;
  const auto number = [&](std::size_t i) {
    return files::scalar_at<std::uint32_t>(frame.data() + 4 * i, std::endian::little);
  };
  bool is_sound =
      frame.size() >= kHeader_bytes && number(0) == static_cast<std::uint32_t>(bits.allocated / 8);
  std::size_t least = kHeader_bytes;
  for (std::size_t i = 1; is_sound && i <= number(0); ++i) {
    is_sound = number(i) >= least && number(i) < frame.size();
    least = static_cast<std::size_t>(number(i)) + 1;
  }
  if (!is_sound) throw InvalidInput(file, "pixel data", "cannot be decoded: are no RLE");
}

bool is_jpeg_2000(E_TransferSyntax syntax) {
  return syntax == EXS_JPEG2000LosslessOnly || syntax == EXS_JPEG2000;
}

// Stored pixels in this machine's byte order.
std::vector<char> stored_pixels(const std::filesystem::path& file, DcmDataset& dataset, const PixelBits& bits,
                                const DicomFrame& frame) {
  DcmElement* element = nullptr;
  dataset.findAndGetElement(DCM_PixelData, element);
  auto* pixels = dynamic_cast<DcmPixelData*>(element);
  if (!pixels) throw InvalidInput(file, "pixel data", "are missing");
  const E_TransferSyntax syntax = dataset.getOriginalXfer();
  const std::size_t count = byte_count(frame, bits);
  if (is_jpeg_2000(syntax))
    return decoded_jpeg2000(file, codestream_of(file, dataset, *pixels, frame.number), frame, bits);
  if (syntax == EXS_RLELossless)
    refuse_broken_rle(file, codestream_of(file, dataset, *pixels, frame.number), bits);
  if (!DcmXfer(syntax).isEncapsulated()) {
    const std::size_t needed = count * (static_cast<std::size_t>(frame.number) + 1);
    if (pixels->getLength() < needed) {
      throw InvalidInput(
          file, "pixel data",
          "end early: " + std::to_string(pixels->getLength()) + " of " + std::to_string(needed) + " bytes");
    }
  }
  Uint32 decoded_count = 0, fragment = 0;
  if (pixels->getUncompressedFrameSize(&dataset, decoded_count).bad() || decoded_count != count)
    throw InvalidInput(file, "pixel data", "are of another size than the header says");
  // An even number of bytes, as DCMTK asks for.
  std::vector<char> bytes(count + count % 2);
  OFString color_model;
  const OFCondition condition =
      pixels->getUncompressedFrame(&dataset, static_cast<Uint32>(frame.number), fragment, bytes.data(),
                                   static_cast<Uint32>(bytes.size()), color_model);
  if (condition.bad()) {
    throw InvalidInput(
        file, "pixel data",
        std::string("cannot be decoded (") + DcmXfer(syntax).getXferName() + "): " + condition.text());
  }
  return bytes;
}

}  // namespace

DicomPixels::DicomPixels(std::filesystem::path file, std::shared_ptr<DcmDataset> dataset)
    : file_(std::move(file)), dataset_(std::move(dataset)) {
  for (unsigned long i = dataset_->card(); i-- > 0;) {
    const DcmElement* element = dataset_->getElement(i);
    const Uint16 group = element->getTag().getGroup();
    if (group != 0x0028 && group != 0x7FE0) delete dataset_->remove(i);
  }
}

void DicomPixels::append_frame(const DicomFrame& frame, std::vector<float>& values) const {
  const std::string colors = text_of(*dataset_, DCM_PhotometricInterpretation);
  if (unsigned_short_of(*dataset_, DCM_SamplesPerPixel, 1) != 1 || colors == "PALETTE COLOR")
    throw InvalidInput(file_, "", "is a picture in colours, not a slice");
  const PixelBits bits = pixel_bits_of(file_, *dataset_);
  const std::vector<char> stored = stored_pixels(file_, *dataset_, bits, frame);
  const std::size_t count = static_cast<std::size_t>(frame.columns) * static_cast<std::size_t>(frame.rows);
  if (bits.allocated == 8) append_rescaled<std::uint8_t>(stored, count, bits, frame, values);
  if (bits.allocated == 16) append_rescaled<std::uint16_t>(stored, count, bits, frame, values);
  if (bits.allocated == 32) append_rescaled<std::uint32_t>(stored, count, bits, frame, values);
}

}  // namespace arthronaut::images
