#include "planning/images/dicom_slice.h"

#include <gdcmImageReader.h>
#include <gdcmTrace.h>

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/images/dicom_elements.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

// A decimal string with `count` values; nullopt when it is absent or anything else.
std::optional<std::vector<double>> decimals_of(const DicomElements& elements, std::uint16_t group,
                                               std::uint16_t element, std::size_t count) {
  const std::string text = elements.text(group, element);
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

void read_geometry(const DicomElements& elements, DicomSlice& slice) {
  const auto position = decimals_of(elements, 0x0020, 0x0032, 3);
  const auto orientation = decimals_of(elements, 0x0020, 0x0037, 6);
  const auto spacing = decimals_of(elements, 0x0028, 0x0030, 2);
  if (!position || !orientation || !spacing) return;
  slice.position_mm = Eigen::Vector3d(position->data());
  slice.along_columns = Eigen::Vector3d(orientation->data());
  slice.along_rows = Eigen::Vector3d(orientation->data() + 3);
  slice.row_spacing_mm = (*spacing)[0];
  slice.column_spacing_mm = (*spacing)[1];
  // Directions are written with few digits: near enough to unit and to each other's normal is made exactly
  // so.
  const double skew = slice.along_columns.dot(slice.along_rows);
  if (std::abs(slice.along_columns.norm() - 1) > 0.01 || std::abs(slice.along_rows.norm() - 1) > 0.01 ||
      std::abs(skew) > 0.01 || slice.row_spacing_mm <= 0 || slice.column_spacing_mm <= 0) {
    throw InvalidInput(slice.file, "image orientation or pixel spacing", "is not one");
  }
  slice.along_columns.normalize();
  slice.along_rows =
      (slice.along_rows - slice.along_rows.dot(slice.along_columns) * slice.along_columns).normalized();
  slice.has_geometry = true;
}

std::size_t pixel_count(const DicomSlice& slice) {
  return static_cast<std::size_t>(slice.rows) * static_cast<std::size_t>(slice.columns);
}

// Pixels as they lie in the file. The bits beside the stored ones may hold overlays of old scanners: cut off.
void append_raw_pixels(const DicomSlice& slice, const DicomElements& elements, std::vector<float>& values) {
  const int allocated = elements.unsigned_short(0x0028, 0x0100, 16);
  const int stored = elements.unsigned_short(0x0028, 0x0101, allocated);
  const int high_bit = elements.unsigned_short(0x0028, 0x0102, stored - 1);
  const bool is_signed = elements.unsigned_short(0x0028, 0x0103, 0) == 1;
  if ((allocated != 8 && allocated != 16 && allocated != 32) || stored < 1 || stored > allocated ||
      high_bit >= allocated || high_bit + 1 < stored) {
    throw InvalidInput(slice.file, "pixel format", "is not one that is read");
  }
  const Scalar type = allocated == 8 ? Scalar::UInt8 : allocated == 16 ? Scalar::UInt16 : Scalar::UInt32;
  const std::size_t width = bytes_per(type), count = pixel_count(slice);
  if (elements.raw_pixels.size() < count * width) {
    throw InvalidInput(slice.file, "pixel data",
                       "end early: " + std::to_string(elements.raw_pixels.size()) + " of " +
                           std::to_string(count * width) + " bytes");
  }
  const auto shift = static_cast<unsigned>(high_bit + 1 - stored);
  const std::uint64_t mask = (std::uint64_t{1} << static_cast<unsigned>(stored)) - 1, sign = (mask >> 1U) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits =
        static_cast<std::uint64_t>(decoded(type, elements.order, elements.raw_pixels.data() + i * width));
    const std::uint64_t value = bits >> shift & mask;
    const double number =
        static_cast<double>(value) - (is_signed && (value & sign) ? static_cast<double>(mask) + 1 : 0);
    values.push_back(static_cast<float>(slice.slope * number + slice.intercept));
  }
}

Scalar scalar_of(const DicomSlice& slice, const gdcm::PixelFormat& format) {
  switch (format.GetScalarType()) {
    case gdcm::PixelFormat::INT8:
      return Scalar::Int8;
    case gdcm::PixelFormat::UINT8:
      return Scalar::UInt8;
    case gdcm::PixelFormat::INT12:
    case gdcm::PixelFormat::INT16:
      return Scalar::Int16;
    case gdcm::PixelFormat::UINT12:
    case gdcm::PixelFormat::UINT16:
      return Scalar::UInt16;
    case gdcm::PixelFormat::INT32:
      return Scalar::Int32;
    case gdcm::PixelFormat::UINT32:
      return Scalar::UInt32;
    default:
      throw InvalidInput(slice.file, "pixel format", "is not one that is read");
  }
}

void append_decompressed_pixels(const DicomSlice& slice, const std::string& syntax,
                                std::vector<float>& values) {
  // GDCM prints what it stumbles over; what matters of it becomes an exception here.
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  gdcm::Trace::DebugOff();
  gdcm::ImageReader reader;
  reader.SetFileName(slice.file.c_str());
  std::vector<char> buffer;
  Scalar type = Scalar::Int16;
  try {
    if (!reader.Read())
      throw InvalidInput(slice.file, "pixel data", "cannot be read (transfer syntax " + syntax + ")");
    const gdcm::Image& image = reader.GetImage();
    type = scalar_of(slice, image.GetPixelFormat());
    const std::size_t expected = pixel_count(slice) * bytes_per(type);
    if (image.GetColumns() != static_cast<unsigned>(slice.columns) ||
        image.GetRows() != static_cast<unsigned>(slice.rows) || image.GetBufferLength() != expected) {
      throw InvalidInput(slice.file, "pixel data", "are of another size than the header says");
    }
    buffer.resize(expected);
    if (!image.GetBuffer(buffer.data())) {
      throw InvalidInput(slice.file, "pixel data", "cannot be decompressed (transfer syntax " + syntax + ")");
    }
  } catch (const gdcm::Exception&) {
    throw InvalidInput(slice.file, "pixel data", "cannot be decompressed (transfer syntax " + syntax + ")");
  }
  for (std::size_t at = 0; at < buffer.size(); at += bytes_per(type)) {
    const double stored = decoded(type, std::endian::native, buffer.data() + at);
    values.push_back(static_cast<float>(slice.slope * stored + slice.intercept));
  }
}

}  // namespace

Eigen::Vector3d DicomSlice::normal() const { return along_columns.cross(along_rows); }

std::optional<DicomSlice> read_dicom_header(const std::filesystem::path& file) {
  const std::string text = files::read_text(file);
  if (!has_dicom_mark(text)) return std::nullopt;
  const DicomElements elements = parse_dicom(file, text);
  DicomSlice slice;
  slice.file = file;
  slice.series_uid = elements.text(0x0020, 0x000e);
  slice.series_number = elements.text(0x0020, 0x0011);
  slice.description = elements.text(0x0008, 0x103e);
  slice.modality = elements.text(0x0008, 0x0060);
  slice.rows = elements.unsigned_short(0x0028, 0x0010, 0);
  slice.columns = elements.unsigned_short(0x0028, 0x0011, 0);
  slice.samples_per_pixel = elements.unsigned_short(0x0028, 0x0002, 1);
  // Plans, contours and reports of the same study have no rows.
  slice.is_image = slice.rows > 0 && slice.columns > 0;
  if (const auto frames = decimals_of(elements, 0x0028, 0x0008, 1))
    slice.frames = static_cast<int>((*frames)[0]);
  if (const auto echo = decimals_of(elements, 0x0018, 0x0081, 1)) slice.echo_time_ms = (*echo)[0];
  if (const auto slope = decimals_of(elements, 0x0028, 0x1053, 1)) slice.slope = (*slope)[0];
  if (const auto intercept = decimals_of(elements, 0x0028, 0x1052, 1)) slice.intercept = (*intercept)[0];
  read_geometry(elements, slice);
  return slice;
}

void append_dicom_pixels(const DicomSlice& slice, std::vector<float>& values) {
  if (slice.samples_per_pixel != 1)
    throw InvalidInput(slice.file, "", "is a picture in colours, not a slice");
  const DicomElements elements = parse_dicom(slice.file, files::read_text(slice.file));
  if (!elements.has_pixel_data) throw InvalidInput(slice.file, "pixel data", "are missing");
  if (elements.is_compressed) {
    append_decompressed_pixels(slice, elements.transfer_syntax, values);
  } else {
    append_raw_pixels(slice, elements, values);
  }
}

}  // namespace arthronaut::images
