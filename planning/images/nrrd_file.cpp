#include <cmath>

#include "planning/geometry/error.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

struct Header {
  std::map<std::string, std::string> fields;
  std::size_t bytes = 0;

  [[nodiscard]] std::string field(std::string_view key, std::string_view other_key = "") const {
    auto found = fields.find(std::string(key));
    if (found == fields.end()) found = fields.find(std::string(other_key));
    return found == fields.end() ? "" : found->second;
  }
};

Header parse_header(const std::filesystem::path& file, std::string_view text) {
  if (!text.starts_with("NRRD000")) throw InvalidInput(file, "line 1", "is not an NRRD file");
  Header header;
  std::size_t line_number = 0;
  while (header.bytes < text.size()) {
    const std::size_t end = std::min(text.find('\n', header.bytes), text.size());
    const std::string line = trimmed(text.substr(header.bytes, end - header.bytes));
    header.bytes = std::min(end + 1, text.size());
    ++line_number;
    if (line.empty()) return header;  // the data follow
    if (line.front() == '#' || line_number == 1 || line.find(":=") != std::string::npos) continue;
    const auto colon = line.find(": ");
    if (colon == std::string::npos) {
      throw InvalidInput(file, "line " + std::to_string(line_number), "is not a field of an NRRD header");
    }
    header.fields[lower_case(line.substr(0, colon))] = trimmed(std::string_view(line).substr(colon + 2));
  }
  return header;
}

Scalar scalar_of(const std::filesystem::path& file, const std::string& name) {
  static const std::map<std::string, Scalar> kNames{{"signed char", Scalar::Int8},
                                                    {"int8", Scalar::Int8},
                                                    {"int8_t", Scalar::Int8},
                                                    {"uchar", Scalar::UInt8},
                                                    {"unsigned char", Scalar::UInt8},
                                                    {"uint8", Scalar::UInt8},
                                                    {"uint8_t", Scalar::UInt8},
                                                    {"short", Scalar::Int16},
                                                    {"short int", Scalar::Int16},
                                                    {"signed short", Scalar::Int16},
                                                    {"signed short int", Scalar::Int16},
                                                    {"int16", Scalar::Int16},
                                                    {"int16_t", Scalar::Int16},
                                                    {"ushort", Scalar::UInt16},
                                                    {"unsigned short", Scalar::UInt16},
                                                    {"unsigned short int", Scalar::UInt16},
                                                    {"uint16", Scalar::UInt16},
                                                    {"uint16_t", Scalar::UInt16},
                                                    {"int", Scalar::Int32},
                                                    {"signed int", Scalar::Int32},
                                                    {"int32", Scalar::Int32},
                                                    {"int32_t", Scalar::Int32},
                                                    {"uint", Scalar::UInt32},
                                                    {"unsigned int", Scalar::UInt32},
                                                    {"uint32", Scalar::UInt32},
                                                    {"uint32_t", Scalar::UInt32},
                                                    {"longlong", Scalar::Int64},
                                                    {"long long", Scalar::Int64},
                                                    {"int64", Scalar::Int64},
                                                    {"int64_t", Scalar::Int64},
                                                    {"ulonglong", Scalar::UInt64},
                                                    {"unsigned long long", Scalar::UInt64},
                                                    {"uint64", Scalar::UInt64},
                                                    {"uint64_t", Scalar::UInt64},
                                                    {"float", Scalar::Float32},
                                                    {"double", Scalar::Float64}};
  const auto found = kNames.find(lower_case(name));
  if (found == kNames.end())
    throw InvalidInput(file, "type", "\"" + name.substr(0, 40) + "\" holds no single numbers");
  return found->second;
}

// Signs that take the named space to LPS.
Eigen::Vector3d lps_from_space(const std::filesystem::path& file, const std::string& space) {
  const std::string name = lower_case(space);
  if (name == "left-posterior-superior" || name == "lps") return {1, 1, 1};
  if (name == "right-anterior-superior" || name == "ras") return {-1, -1, 1};
  if (name == "left-anterior-superior" || name == "las") return {1, -1, 1};
  throw InvalidInput(file, "space",
                     name.empty()
                         ? "is missing: the file does not say where left is"
                         : "\"" + name.substr(0, 40) + "\" is not a space of a patient that is read");
}

// `storage` holds what is not in `text`.
std::string_view voxel_bytes(const std::filesystem::path& file, const Header& header, std::string_view text,
                             std::size_t voxel_bytes_count, std::string& storage) {
  for (const char* key : {"line skip", "lineskip", "byte skip", "byteskip"}) {
    const std::string skip = header.field(key);
    if (!skip.empty() && skip != "0")
      throw InvalidInput(file, key, "is not read: save the file again without it");
  }
  const std::string encoding = lower_case(header.field("encoding"));
  const bool is_packed = encoding == "gzip" || encoding == "gz";
  if (!is_packed && encoding != "raw")
    throw InvalidInput(file, "encoding", "\"" + encoding.substr(0, 40) + "\" is not read: raw and gzip are");
  std::string_view data = text.substr(header.bytes);
  const std::string data_file = header.field("data file", "datafile");
  if (!data_file.empty()) {
    storage = read_data_file(file, data_file, most_stored_bytes(voxel_bytes_count));
    data = storage;
  }
  if (!is_packed) return data;
  storage = inflated(file, data, voxel_bytes_count);
  return storage;
}

}  // namespace

Volume parse_nrrd(const std::filesystem::path& file, std::string_view text, std::size_t most_bytes) {
  const Header header = parse_header(file, text);
  Volume volume;
  volume.format = "NRRD";
  if (header.field("dimension") != "3") {
    throw InvalidInput(file, "dimension", "is " + header.field("dimension").substr(0, 10) + ", expected 3");
  }
  const auto sizes = numbers_of(file, "sizes", header.field("sizes"));
  if (sizes.size() != 3) throw InvalidInput(file, "sizes", "must hold 3 numbers");
  for (int i = 0; i < 3; ++i) {
    const double n = sizes[static_cast<std::size_t>(i)];
    if (!(n >= 1 && n <= 65536) || n != std::floor(n)) throw InvalidInput(file, "sizes", "are out of range");
    volume.size[i] = static_cast<int>(n);
  }
  const Eigen::Vector3d signs = lps_from_space(file, header.field("space"));
  const auto directions = numbers_of(file, "space directions", header.field("space directions"));
  if (directions.size() != 9) throw InvalidInput(file, "space directions", "must hold 3 vectors");
  const std::string origin_text = header.field("space origin");
  const auto origin = numbers_of(file, "space origin", origin_text);
  if (origin.size() != 3) throw InvalidInput(file, "space origin", "must hold 3 numbers");
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 3; ++i) {
      volume.lps_from_index.linear()(i, axis) = signs[i] * directions[static_cast<std::size_t>(3 * axis + i)];
    }
    volume.lps_from_index.translation()[axis] = signs[axis] * origin[static_cast<std::size_t>(axis)];
  }
  Samples samples;
  samples.type = scalar_of(file, header.field("type"));
  const std::string endian = lower_case(header.field("endian"));
  if (endian == "big") {
    samples.order = std::endian::big;
  } else if (endian != "little" && bytes_per(samples.type) > 1) {
    throw InvalidInput(file, "endian", "must be little or big");
  }
  const std::size_t width = bytes_per(samples.type);
  const std::size_t count = checked_voxel_count(file, volume.size, width, most_bytes);
  std::string storage;
  set_values(volume, file, voxel_bytes(file, header, text, count * width, storage), samples);
  finish(volume, file);
  return volume;
}

}  // namespace arthronaut::images
