#include "planning/images/dicom_file.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcistrmb.h>
#include <dcmtk/dcmdata/dcistrmf.h>
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

// Longer values stay in the file until they are asked for.
constexpr Uint32 kLongestValueAtOnce_bytes = 4096;

void prepare_dcmtk() {
  static const bool is_ready = [] {
    // What DCMTK stumbles over becomes an exception here.
    OFLog::configure(OFLogger::OFF_LOG_LEVEL);
    // What follows the pixels is padding and signatures, and often not even that.
    dcmStopParsingAfterElement.set(DCM_PixelData);
    DcmRLEDecoderRegistration::registerCodecs();
    DJDecoderRegistration::registerCodecs();
    DJLSDecoderRegistration::registerCodecs();
    return true;
  }();
  static_cast<void>(is_ready);
}

// DCMTK tells what it stumbles over by its conditions, but its checks of broken texts may throw what the
// standard library throws there (3.6.7, DcmByteString::verify).
void read_object(DcmObject& object, const std::filesystem::path& file, DcmInputStream& stream,
                 E_TransferSyntax syntax) {
  const auto fail = [&](const char* what) {
    throw InvalidInput(file, "byte " + std::to_string(stream.tell()),
                       std::string("broken or cut off: ") + what);
  };
  object.transferInit();
  try {
    const OFCondition condition = object.read(stream, syntax, EGL_noChange, kLongestValueAtOnce_bytes);
    if (condition.bad()) fail(condition.text());
  } catch (const std::logic_error&) {
    fail("a text that cannot be taken apart");
  }
  object.transferEnd();
}

std::shared_ptr<DcmDataset> read_dataset(const std::filesystem::path& file, DcmInputStream& stream,
                                         E_TransferSyntax syntax) {
  auto dataset = std::make_shared<DcmDataset>();
  read_object(*dataset, file, stream, syntax);
  return dataset;
}

}  // namespace

bool has_dicom_mark(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw IoError(file, std::strerror(errno));
  char start[132] = {};
  return stream.read(start, sizeof(start)) && std::string_view(start + 128, 4) == "DICM";
}

std::shared_ptr<DcmDataset> open_dicom(const std::filesystem::path& file, std::size_t most_bytes) {
  prepare_dcmtk();
  DcmInputFileStream stream{OFFilename(file.c_str())};
  if (stream.status().bad()) throw IoError(file, stream.status().text());
  DcmMetaInfo meta;
  read_object(meta, file, stream, EXS_Unknown);
  const std::string uid = text_of(meta, DCM_TransferSyntaxUID);
  if (uid.empty()) throw InvalidInput(file, "", "names no transfer syntax");
  const DcmXfer syntax(uid.c_str());
  if (syntax.getXfer() == EXS_Unknown)
    throw InvalidInput(file, "", "has the transfer syntax " + uid.substr(0, 64) + ", which is not read");
  if (syntax.getStreamCompression() == ESC_none) return read_dataset(file, stream, syntax.getXfer());
  // DCMTK would unpack whatever comes: here it is bounded.
  const std::string packed = files::read_text(file);
  const auto start = std::min(packed.size(), static_cast<std::size_t>(stream.tell()));
  const std::string whole =
      inflated(file, std::string_view(packed).substr(start), most_bytes, Compression::Raw);
  DcmInputBufferStream buffer;
  buffer.setBuffer(whole.data(), static_cast<offile_off_t>(whole.size()));
  buffer.setEos();
  return read_dataset(file, buffer, EXS_LittleEndianExplicit);
}

std::string series_uid_before_damage(const std::filesystem::path& file) {
  prepare_dcmtk();
  DcmInputFileStream stream{OFFilename(file.c_str())};
  if (stream.status().bad()) return "";
  DcmMetaInfo meta;
  DcmDataset dataset;
  try {
    read_object(meta, file, stream, EXS_Unknown);
    const DcmXfer syntax(text_of(meta, DCM_TransferSyntaxUID).c_str());
    if (syntax.getXfer() == EXS_Unknown || syntax.getStreamCompression() != ESC_none) return "";
    read_object(dataset, file, stream, syntax.getXfer());
  } catch (const InvalidInput&) {
    // What was read before it stays.
  }
  // Of what was read last a part may be missing, and half a UID is another series'.
  const unsigned long count = dataset.card();
  if (count == 0 || !(dataset.getElement(count - 1)->getTag() > DCM_SeriesInstanceUID)) return "";
  return text_of(dataset, DCM_SeriesInstanceUID);
}

std::string text_of(DcmItem& item, const DcmTagKey& key) {
  OFString found;
  if (item.findAndGetOFStringArray(key, found).bad()) return "";
  std::string text(found.c_str(), found.length());
  while (!text.empty() && text.back() == '\0') text.pop_back();
  return trimmed(text);
}

std::optional<std::vector<double>> decimals_of(DcmItem& item, const DcmTagKey& key, std::size_t count) {
  const std::string text = text_of(item, key);
  std::vector<double> values;
  for (std::size_t at = 0; at <= text.size() && !text.empty();) {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    std::string part = trimmed(std::string_view(text).substr(at, end - at));
    if (part.starts_with('+')) part.erase(0, 1);
    double value = 0;
    const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || stop != part.data() + part.size() || !std::isfinite(value))
      return std::nullopt;
    values.push_back(value);
    at = end + 1;
  }
  if (values.size() != count) return std::nullopt;
  return values;
}

std::optional<bones::Side> side_of(DcmItem& item, const DcmTagKey& key) {
  const std::string text = text_of(item, key);
  if (text == "L") return bones::Side::Left;
  if (text == "R") return bones::Side::Right;
  return std::nullopt;
}

int unsigned_short_of(DcmItem& item, const DcmTagKey& key, int absent) {
  Uint16 value = 0;
  return item.findAndGetUint16(key, value).good() ? static_cast<int>(value) : absent;
}

}  // namespace arthronaut::images
