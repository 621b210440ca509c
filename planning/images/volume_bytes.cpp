#include "planning/images/volume_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::images {

namespace {

template <typename T>
double decode(std::endian order, const char* bytes) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(copy, copy + sizeof(T));
  T value;
  std::memcpy(&value, copy, sizeof(T));
  return static_cast<double>(value);
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
  z_stream stream{};
  if (inflateInit2(&stream, compression == Compression::Raw ? -15 : 15 + 32) != Z_OK)
    throw InvalidInput(file, "", "cannot be decompressed");
  std::string result;
  std::string chunk(1 << 20, '\0');
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
    result.append(chunk.data(), chunk.size() - stream.avail_out);
    if (result.size() > most_bytes) break;
    // Nothing came and nothing went: cut off.
    if (stream.avail_out == chunk.size() && given == stream.avail_in) break;
  }
  const std::size_t place = compressed.size() - left;
  ::inflateEnd(&stream);
  if (result.size() > most_bytes) throw InvalidInput(file, "", "holds more data than its header asks for");
  if (state == Z_DATA_ERROR) {
    throw InvalidInput(file, "byte " + std::to_string(place) + " of the compressed data", "is not valid");
  }
  if (state != Z_STREAM_END) throw InvalidInput(file, "", "the compressed data end too early");
  return result;
}

std::size_t checked_voxel_count(const std::filesystem::path& file, const Eigen::Vector3i& size) {
  if (size.minCoeff() < 1) throw InvalidInput(file, "", "the volume has no voxel along one of its axes");
  const double count = size.cast<double>().prod();
  if (count > 2147483648.0) throw InvalidInput(file, "", "the volume is too large to be one of a knee");
  return static_cast<std::size_t>(count);
}

void set_values(Volume& volume, const std::filesystem::path& file, std::string_view bytes,
                const Samples& samples) {
  const std::size_t count = checked_voxel_count(file, volume.size), width = bytes_per(samples.type);
  if (bytes.size() / width < count) {
    throw InvalidInput(file, "",
                       "ends early: holds " + std::to_string(bytes.size() / width) + " of " +
                           std::to_string(count) + " voxels");
  }
  volume.values.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double value = samples.slope * decoded(samples.type, samples.order, bytes.data() + i * width);
    volume.values[i] = static_cast<float>(value + samples.intercept);
  }
}

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

std::string read_data_file(const std::filesystem::path& header_file, std::string_view name) {
  const std::filesystem::path data(name);
  if (data.empty() || data.has_parent_path() || data == "." || data == "..") {
    throw InvalidInput(header_file, "",
                       "names the data file \"" + std::string(name.substr(0, 40)) +
                           "\": only a file in the same folder is read");
  }
  return files::read_text(header_file.parent_path() / data);
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
