#include "planning/images/volume_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/files/scalar_bytes.h"
#include "planning/geometry/error.h"

namespace arthronaut::images {

namespace {

template <typename T>
double decode(std::endian order, const char* bytes) {
  return static_cast<double>(files::scalar_at<T>(bytes, order));
}

template <typename T>
void set_values_of(Volume& volume, std::size_t count, const char* bytes, const Samples& samples) {
  volume.values.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double value = samples.slope * decode<T>(samples.order, bytes + i * sizeof(T));
    volume.values[i] = static_cast<float>(value + samples.intercept);
  }
}

std::string in_gib(double bytes) {
  constexpr double kGib = 1024.0 * 1024 * 1024;
  return files::format("%.3g GiB", bytes / kGib);
}

// Deflate packs at most 1032 bytes into one (RFC 1951: 258 bytes for two bits).
constexpr std::size_t kMostUnpackedPerByte = 1032;

struct Inflation {
  std::string bytes;
  bool is_at_end = false;  // of the compressed data
};

// Stops, whole buffers of a MiB at a time, as soon as there are more than `most_bytes`.
Inflation inflate_up_to(const std::filesystem::path& file, std::string_view compressed,
                        std::size_t most_bytes, Compression compression) {
  z_stream stream{};
  if (inflateInit2(&stream, compression == Compression::Raw ? -15 : 15 + 32) != Z_OK)
    throw InvalidInput(file, "", "cannot be decompressed");
  Inflation result;
  // At once, as growing by doubling would take twice as much; never more than the data can hold.
  result.bytes.reserve(std::min(most_bytes, compressed.size() * kMostUnpackedPerByte) + (1 << 20));
  std::string chunk(std::min<std::size_t>(most_bytes + 1, 1 << 20), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
  std::size_t left = compressed.size();
  int state = Z_OK;
  while (state == Z_OK || (state == Z_BUF_ERROR && left > 0)) {
    stream.avail_in = static_cast<uInt>(std::min<std::size_t>(left, 1U << 30));
    const std::size_t given = stream.avail_in;
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream.avail_out = static_cast<uInt>(chunk.size());
    state = ::inflate(&stream, Z_NO_FLUSH);
    left -= given - stream.avail_in;
    result.bytes.append(chunk.data(), chunk.size() - stream.avail_out);
    if (result.bytes.size() > most_bytes) break;
    // Nothing came and nothing went: cut off.
    if (stream.avail_out == chunk.size() && given == stream.avail_in) break;
  }
  const std::size_t place = compressed.size() - left;
  ::inflateEnd(&stream);
  if (state == Z_DATA_ERROR) {
    throw InvalidInput(file, "byte " + std::to_string(place) + " of the compressed data", "is not valid");
  }
  result.is_at_end = state == Z_STREAM_END;
  return result;
}

}  // namespace

std::size_t bytes_per(Scalar type) {
  constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

double decoded(Scalar type, std::endian order, const char* bytes) {
  switch (type) {
    case Scalar::Int8:
      return decode<std::int8_t>(order, bytes);
    case Scalar::UInt8:
      return decode<std::uint8_t>(order, bytes);
    case Scalar::Int16:
      return decode<std::int16_t>(order, bytes);
    case Scalar::UInt16:
      return decode<std::uint16_t>(order, bytes);
    case Scalar::Int32:
      return decode<std::int32_t>(order, bytes);
    case Scalar::UInt32:
      return decode<std::uint32_t>(order, bytes);
    case Scalar::Int64:
      return decode<std::int64_t>(order, bytes);
    case Scalar::UInt64:
      return decode<std::uint64_t>(order, bytes);
    case Scalar::Float32:
      return decode<float>(order, bytes);
    case Scalar::Float64:
      break;
  }
  return decode<double>(order, bytes);
}

std::string inflated(const std::filesystem::path& file, std::string_view compressed, std::size_t most_bytes,
                     Compression compression) {
  Inflation inflation = inflate_up_to(file, compressed, most_bytes, compression);
  if (inflation.bytes.size() > most_bytes)
    throw InvalidInput(file, "", "holds more data than its header asks for");
  if (!inflation.is_at_end) throw InvalidInput(file, "", "the compressed data end too early");
  return std::move(inflation.bytes);
}

std::string inflated_start(const std::filesystem::path& file, std::string_view compressed,
                           std::size_t count) {
  return inflate_up_to(file, compressed, count, Compression::GzipOrZlib).bytes.substr(0, count);
}

std::size_t checked_voxel_count(const std::filesystem::path& file, const Eigen::Vector3i& size,
                                std::size_t stored_bytes_per_voxel, std::size_t most_bytes) {
  if (size.minCoeff() < 1) throw InvalidInput(file, "", "the volume has no voxel along one of its axes");
  const double count = size.cast<double>().prod();  // exact: three numbers of 16 bits
  const double needed = count * static_cast<double>(sizeof(float) + stored_bytes_per_voxel);
  if (needed > static_cast<double>(most_bytes)) {
    throw InvalidInput(file, "",
                       files::format("%d x %d x %d voxels would need ", size.x(), size.y(), size.z()) +
                           in_gib(needed) + " of memory, the limit is " +
                           in_gib(static_cast<double>(most_bytes)) +
                           ": no scan of a knee is as large, or a higher limit has to be asked for");
  }
  return static_cast<std::size_t>(count);
}

void report(const VolumeFileOptions& options, double fraction) {
  if (options.on_progress) options.on_progress(fraction);
}

void set_values(Volume& volume, const std::filesystem::path& file, std::string_view bytes,
                const Samples& samples) {
  const auto count = static_cast<std::size_t>(volume.size.cast<std::int64_t>().prod());
  const std::size_t width = bytes_per(samples.type);
  if (bytes.size() / width < count) {
    throw InvalidInput(file, "",
                       "ends early: holds " + std::to_string(bytes.size() / width) + " of " +
                           std::to_string(count) + " voxels");
  }
  switch (samples.type) {
    case Scalar::Int8:
      return set_values_of<std::int8_t>(volume, count, bytes.data(), samples);
    case Scalar::UInt8:
      return set_values_of<std::uint8_t>(volume, count, bytes.data(), samples);
    case Scalar::Int16:
      return set_values_of<std::int16_t>(volume, count, bytes.data(), samples);
    case Scalar::UInt16:
      return set_values_of<std::uint16_t>(volume, count, bytes.data(), samples);
    case Scalar::Int32:
      return set_values_of<std::int32_t>(volume, count, bytes.data(), samples);
    case Scalar::UInt32:
      return set_values_of<std::uint32_t>(volume, count, bytes.data(), samples);
    case Scalar::Int64:
      return set_values_of<std::int64_t>(volume, count, bytes.data(), samples);
    case Scalar::UInt64:
      return set_values_of<std::uint64_t>(volume, count, bytes.data(), samples);
    case Scalar::Float32:
      return set_values_of<float>(volume, count, bytes.data(), samples);
    case Scalar::Float64:
      return set_values_of<double>(volume, count, bytes.data(), samples);
  }
}

namespace {

Modality modality_of(std::string_view in_file, float least) {
  constexpr float kAir_hu = -500;
  if (in_file.empty()) return least < kAir_hu ? Modality::Ct : Modality::Unknown;
  return in_file == "CT" ? Modality::Ct : in_file == "MR" ? Modality::Mr : Modality::Other;
}

}  // namespace

void finish(Volume& volume, const std::filesystem::path& file) {
  const Eigen::Matrix3d axes = volume.lps_from_index.linear();
  if (!volume.lps_from_index.matrix().allFinite())
    throw InvalidInput(file, "", "its orientation is not finite");
  const Eigen::Vector3d spacing = volume.spacing_mm();
  if (!(spacing.minCoeff() > 1e-3) || !(spacing.maxCoeff() < 1e3)) {
    throw InvalidInput(file, "", "its voxels are below 0.001 mm or above 1000 mm");
  }
  if (!(std::abs(axes.determinant()) > 0.05 * spacing.prod())) {
    throw InvalidInput(file, "", "two of its axes run the same way");
  }
  float least = std::numeric_limits<float>::infinity();
  std::size_t not_finite = 0;
  for (const float v : volume.values) {
    if (std::isfinite(v)) least = std::min(least, v);
    not_finite += !std::isfinite(v);
  }
  if (not_finite == volume.values.size()) throw InvalidInput(file, "", "holds no finite value");
  volume.modality = modality_of(volume.modality_in_file, least);
  if (not_finite == 0) return;
  for (float& v : volume.values) v = std::isfinite(v) ? v : least;
  volume.notes.push_back(std::to_string(not_finite) + " voxels were not finite: taken for empty");
}

std::vector<double> numbers_of(const std::filesystem::path& file, const std::string& key,
                               std::string_view value) {
  std::vector<double> result;
  const auto separator = [](char c) { return c == ' ' || c == '\t' || c == ',' || c == '(' || c == ')'; };
  for (std::size_t at = 0; at < value.size();) {
    if (separator(value[at])) {
      ++at;
      continue;
    }
    double number = 0;
    const char* begin = value.data() + at;
    const auto [end, error] = std::from_chars(begin, value.data() + value.size(), number);
    if (error != std::errc() || !std::isfinite(number) ||
        (end != value.data() + value.size() && !separator(*end))) {
      throw InvalidInput(file, key, "is not a list of finite numbers");
    }
    result.push_back(number);
    at += static_cast<std::size_t>(end - begin);
  }
  return result;
}

std::string read_data_file(const std::filesystem::path& header_file, std::string_view name,
                           std::size_t most_bytes) {
  // A name with a NUL or a line feed in it would cut off, or break, whatever is said of it.
  if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
    throw InvalidInput(header_file, "", "names a data file with control characters in its name");
  const std::filesystem::path data(name);
  if (data.empty() || data.has_parent_path() || data == "." || data == "..") {
    throw InvalidInput(header_file, "",
                       "names the data file \"" + std::string(name.substr(0, 40)) +
                           "\": only a file in the same folder is read");
  }
  const std::filesystem::path file = header_file.parent_path() / data;
  if (std::error_code ignored; !std::filesystem::exists(file, ignored))
    throw InvalidInput(header_file, "", "names the data file \"" + data.string() + "\", which is not there");
  return read_bounded(file, most_bytes);
}

std::string read_bounded(const std::filesystem::path& file, std::size_t most_bytes) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  if (!error && bytes > most_bytes) {
    throw InvalidInput(file, "",
                       "is a file of " + in_gib(static_cast<double>(bytes)) + ", the limit is " +
                           in_gib(static_cast<double>(most_bytes)));
  }
  return files::read_text(file);
}

std::string trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n\v\f";
  const auto begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(kSpace) - begin + 1));
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

}  // namespace arthronaut::images
