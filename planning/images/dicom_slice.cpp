#include "planning/images/dicom_slice.h"

#include <gdcmImageReader.h>
#include <gdcmReader.h>
#include <gdcmTrace.h>

#include <Eigen/Geometry>
#include <bit>
#include <charconv>
#include <cmath>
#include <fstream>
#include <set>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

std::string text_of(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
  const gdcm::Tag tag(group, element);
  if (!data.FindDataElement(tag)) return "";
  const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
  if (!bytes) return "";
  std::string text(bytes->GetPointer(), bytes->GetLength());
  while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
  return trimmed(text);
}

// A decimal string with `count` values; nullopt when it is absent or anything else.
std::optional<std::vector<double>> decimals_of(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element,
                                               std::size_t count) {
  const std::string text = text_of(data, group, element);
  std::vector<double> values;
  for (std::size_t at = 0; at <= text.size() && !text.empty();) {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    std::string part = trimmed(std::string_view(text).substr(at, end - at));
    if (part.starts_with('+')) part.erase(0, 1);
    double value = 0;
    const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || stop != part.data() + part.size() || !std::isfinite(value)) return std::nullopt;
    values.push_back(value);
    at = end + 1;
  }
  if (values.size() != count) return std::nullopt;
  return values;
}

int unsigned_short_of(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element, int absent) {
  const gdcm::Tag tag(group, element);
  if (!data.FindDataElement(tag)) return absent;
  const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
  if (!bytes || bytes->GetLength() < 2) return absent;
  // GDCM has put the bytes into the order of this machine.
  return static_cast<int>(decoded(Scalar::UInt16, std::endian::native, bytes->GetPointer()));
}

// GDCM prints what it stumbles over; what matters of it becomes an exception here.
void silence_gdcm() {
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  gdcm::Trace::DebugOff();
}

bool has_dicom_mark(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  char start[132] = {};
  stream.read(start, sizeof start);
  return stream.gcount() == sizeof start && std::string_view(start + 128, 4) == "DICM";
}

void read_geometry(const gdcm::DataSet& data, DicomSlice& slice) {
  const auto position = decimals_of(data, 0x0020, 0x0032, 3);
  const auto orientation = decimals_of(data, 0x0020, 0x0037, 6);
  const auto spacing = decimals_of(data, 0x0028, 0x0030, 2);
  if (!position || !orientation || !spacing) return;
  slice.position_mm = Eigen::Vector3d(position->data());
  slice.along_columns = Eigen::Vector3d(orientation->data());
  slice.along_rows = Eigen::Vector3d(orientation->data() + 3);
  slice.row_spacing_mm = (*spacing)[0];
  slice.column_spacing_mm = (*spacing)[1];
  // Directions are written with few digits: near enough to unit and to each other's normal is made exactly so.
  const double skew = slice.along_columns.dot(slice.along_rows);
  if (std::abs(slice.along_columns.norm() - 1) > 0.01 || std::abs(slice.along_rows.norm() - 1) > 0.01 ||
      std::abs(skew) > 0.01 || slice.row_spacing_mm <= 0 || slice.column_spacing_mm <= 0) {
    throw InvalidInput(slice.file, "image orientation or pixel spacing", "is not one");
  }
  slice.along_columns.normalize();
  slice.along_rows = (slice.along_rows - slice.along_rows.dot(slice.along_columns) * slice.along_columns).normalized();
  slice.has_geometry = true;
}

Scalar scalar_of(const DicomSlice& slice, const gdcm::PixelFormat& format) {
  switch (format.GetScalarType()) {
    case gdcm::PixelFormat::INT8: return Scalar::Int8;
    case gdcm::PixelFormat::UINT8: return Scalar::UInt8;
    case gdcm::PixelFormat::INT12:
    case gdcm::PixelFormat::INT16: return Scalar::Int16;
    case gdcm::PixelFormat::UINT12:
    case gdcm::PixelFormat::UINT16: return Scalar::UInt16;
    case gdcm::PixelFormat::INT32: return Scalar::Int32;
    case gdcm::PixelFormat::UINT32: return Scalar::UInt32;
    case gdcm::PixelFormat::FLOAT32: return Scalar::Float32;
    case gdcm::PixelFormat::FLOAT64: return Scalar::Float64;
    default: throw InvalidInput(slice.file, "pixel format", "is not one that is read");
  }
}

// GDCM fills up pixels that are cut off without a word. So the pixel data's element is looked up in the file itself, and
// must end before the file does.
bool are_pixels_cut_off(const DicomSlice& slice, const gdcm::ImageReader& reader) {
  const gdcm::TransferSyntax syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
  if (syntax.IsEncapsulated() || syntax == gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian) return false;
  const gdcm::Tag tag(0x7fe0, 0x0010);
  const gdcm::DataSet& data = reader.GetFile().GetDataSet();
  const gdcm::ByteValue* value = data.FindDataElement(tag) ? data.GetDataElement(tag).GetByteValue() : nullptr;
  if (!value) return true;
  const auto length = static_cast<double>(static_cast<std::size_t>(value->GetLength()));
  const bool is_big = syntax.GetSwapCode() == gdcm::SwapCode::BigEndian;
  const std::endian order = is_big ? std::endian::big : std::endian::little;
  const std::string bytes = files::read_text(slice.file);
  const std::string_view tag_bytes(is_big ? "\x7f\xe0\x00\x10" : "\xe0\x7f\x10\x00", 4);
  for (auto at = bytes.find(tag_bytes); at != std::string::npos && at + 12 <= bytes.size();
       at = bytes.find(tag_bytes, at + 1)) {
    const bool is_explicit = bytes[at + 4] == 'O';  // OW or OB, two bytes unused, the length
    const std::size_t length_at = at + (is_explicit ? 8 : 4);
    if (decoded(Scalar::UInt32, order, bytes.data() + length_at) != length) continue;
    return static_cast<double>(bytes.size() - length_at - 4) < length;
  }
  return true;
}

}  // namespace

Eigen::Vector3d DicomSlice::normal() const { return along_columns.cross(along_rows); }

std::optional<DicomSlice> read_dicom_header(const std::filesystem::path& file) {
  silence_gdcm();
  if (!has_dicom_mark(file)) return std::nullopt;
  try {
    gdcm::Reader reader;
    reader.SetFileName(file.c_str());
    std::set<gdcm::Tag> skipped;
    if (!reader.ReadUpToTag(gdcm::Tag(0x7fe0, 0x0010), skipped)) {
      throw InvalidInput(file, "", "is a DICOM file that cannot be read: broken or cut off");
    }
    const gdcm::DataSet& data = reader.GetFile().GetDataSet();
    DicomSlice slice;
    slice.file = file;
    slice.series_uid = text_of(data, 0x0020, 0x000e);
    slice.series_number = text_of(data, 0x0020, 0x0011);
    slice.description = text_of(data, 0x0008, 0x103e);
    slice.modality = text_of(data, 0x0008, 0x0060);
    slice.rows = unsigned_short_of(data, 0x0028, 0x0010, 0);
    slice.columns = unsigned_short_of(data, 0x0028, 0x0011, 0);
    slice.samples_per_pixel = unsigned_short_of(data, 0x0028, 0x0002, 1);
    // Plans, contours and reports of the same study have no rows.
    slice.has_pixels = slice.rows > 0 && slice.columns > 0;
    if (const auto frames = decimals_of(data, 0x0028, 0x0008, 1)) slice.frames = static_cast<int>((*frames)[0]);
    if (const auto echo = decimals_of(data, 0x0018, 0x0081, 1)) slice.echo_time_ms = (*echo)[0];
    if (const auto slope = decimals_of(data, 0x0028, 0x1053, 1)) slice.slope = (*slope)[0];
    if (const auto intercept = decimals_of(data, 0x0028, 0x1052, 1)) slice.intercept = (*intercept)[0];
    read_geometry(data, slice);
    return slice;
  } catch (const gdcm::Exception&) {
    throw InvalidInput(file, "", "is a DICOM file that cannot be read: broken or cut off");
  }
}

void append_dicom_pixels(const DicomSlice& slice, std::vector<float>& values) {
  silence_gdcm();
  if (slice.samples_per_pixel != 1) throw InvalidInput(slice.file, "", "is a picture in colours, not a slice");
  gdcm::ImageReader reader;
  reader.SetFileName(slice.file.c_str());
  std::vector<char> buffer;
  Scalar type = Scalar::Int16;
  try {
    if (!reader.Read()) throw InvalidInput(slice.file, "", "its pixels cannot be read: broken, cut off, or no image");
    const gdcm::Image& image = reader.GetImage();
    type = scalar_of(slice, image.GetPixelFormat());
    const std::size_t expected =
        static_cast<std::size_t>(slice.rows) * static_cast<std::size_t>(slice.columns) * bytes_per(type);
    if (image.GetColumns() != static_cast<unsigned>(slice.columns) ||
        image.GetRows() != static_cast<unsigned>(slice.rows) || image.GetBufferLength() != expected) {
      throw InvalidInput(slice.file, "pixel data", "are of another size than the header says");
    }
    if (are_pixels_cut_off(slice, reader)) throw InvalidInput(slice.file, "pixel data", "end early: the file is cut off");
    buffer.resize(expected);
    if (!image.GetBuffer(buffer.data())) {
      const gdcm::TransferSyntax syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
      throw InvalidInput(slice.file, "pixel data",
                         std::string("cannot be decoded (") + gdcm::TransferSyntax::GetTSString(syntax) + ")");
    }
  } catch (const gdcm::Exception&) {
    throw InvalidInput(slice.file, "pixel data", "cannot be decoded");
  }
  for (std::size_t at = 0; at < buffer.size(); at += bytes_per(type)) {
    const double stored = decoded(type, std::endian::native, buffer.data() + at);
    values.push_back(static_cast<float>(slice.slope * stored + slice.intercept));
  }
}

}  // namespace arthronaut::images
