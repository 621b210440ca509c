#include <cmath>

#include "planning/geometry/error.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

struct Header {
  std::map<std::string, std::string> fields;  // keys in lower case
  std::size_t bytes = 0;                      // up to the data, where they are in the same file

  [[nodiscard]] std::string field(std::initializer_list<const char*> keys) const {
    for (const char* key : keys) {
      if (const auto found = fields.find(key); found != fields.end()) return found->second;
    }
    return "";
  }
  [[nodiscard]] bool is_true(std::initializer_list<const char*> keys) const {
    return lower_case(field(keys)) == "true";
  }
};

Header parse_header(const std::filesystem::path& file, std::string_view text) {
  Header header;
  std::size_t line_number = 0;
  while (header.bytes < text.size()) {
    const std::size_t end = std::min(text.find('\n', header.bytes), text.size());
    const std::string line = trimmed(text.substr(header.bytes, end - header.bytes));
    header.bytes = std::min(end + 1, text.size());
    ++line_number;
    if (line.empty()) continue;
    const auto equals = line.find('=');
    if (equals == std::string::npos) {
      throw InvalidInput(file, "line " + std::to_string(line_number), "is not a field of a MetaImage header");
    }
    const std::string key = lower_case(trimmed(std::string_view(line).substr(0, equals)));
    header.fields[key] = trimmed(std::string_view(line).substr(equals + 1));
    if (key == "elementdatafile") return header;  // always the last
  }
  throw InvalidInput(file, "", "the header has no ElementDataFile");
}

Scalar scalar_of(const std::filesystem::path& file, const std::string& name) {
  static const std::map<std::string, Scalar> kNames{
      {"MET_CHAR", Scalar::Int8},         {"MET_UCHAR", Scalar::UInt8},   {"MET_SHORT", Scalar::Int16},
      {"MET_USHORT", Scalar::UInt16},     {"MET_INT", Scalar::Int32},     {"MET_UINT", Scalar::UInt32},
      {"MET_LONG", Scalar::Int32},        {"MET_ULONG", Scalar::UInt32},  {"MET_LONG_LONG", Scalar::Int64},
      {"MET_ULONG_LONG", Scalar::UInt64}, {"MET_FLOAT", Scalar::Float32}, {"MET_DOUBLE", Scalar::Float64}};
  const auto found = kNames.find(name);
  if (found == kNames.end()) {
    throw InvalidInput(file, "ElementType", "\"" + name.substr(0, 40) + "\" holds no single numbers");
  }
  return found->second;
}

std::vector<double> field_of_three(const std::filesystem::path& file, const Header& header,
                                   std::initializer_list<const char*> keys, std::size_t count) {
  const auto values = numbers_of(file, *keys.begin(), header.field(keys));
  if (values.size() != count) {
    throw InvalidInput(file, *keys.begin(), "must hold " + std::to_string(count) + " numbers");
  }
  return values;
}

}  // namespace

Volume parse_metaimage(const std::filesystem::path& file, std::string_view text, std::size_t most_bytes) {
  const Header header = parse_header(file, text);
  Volume volume;
  volume.format = "MetaImage";
  if (header.field({"ndims"}) != "3") throw InvalidInput(file, "NDims", "must be 3");
  const std::string channels = header.field({"elementnumberofchannels"});
  if (!channels.empty() && channels != "1") throw InvalidInput(file, "ElementNumberOfChannels", "must be 1");
  const auto sizes = field_of_three(file, header, {"dimsize"}, 3);
  const auto spacing = field_of_three(file, header, {"elementspacing", "elementsize"}, 3);
  // The format calls its three axes for the patient the same as DICOM: LPS. The matrix holds the direction of
  // i, then of j, then of k. Without it the file does not say how it lies.
  const auto directions = field_of_three(file, header, {"transformmatrix", "rotation", "orientation"}, 9);
  const auto origin = field_of_three(file, header, {"offset", "position", "origin"}, 3);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(sizes[axis] >= 1 && sizes[axis] <= 65536) || sizes[axis] != std::floor(sizes[axis])) {
      throw InvalidInput(file, "DimSize", "is out of range");
    }
    const auto a = static_cast<Eigen::Index>(axis);
    volume.size[a] = static_cast<int>(sizes[axis]);
    for (std::size_t i = 0; i < 3; ++i) {
      volume.lps_from_index.linear()(static_cast<Eigen::Index>(i), a) =
          spacing[axis] * directions[3 * axis + i];
    }
    volume.lps_from_index.translation()[a] = origin[axis];
  }

  Samples samples;
  samples.type = scalar_of(file, header.field({"elementtype"}));
  if (header.is_true({"binarydatabyteordermsb", "elementbyteordermsb"})) samples.order = std::endian::big;
  const std::string data_name = header.field({"elementdatafile"});
  if (data_name.starts_with("LIST") || data_name.find('%') != std::string::npos) {
    throw InvalidInput(file, "ElementDataFile", "a list of files is not read: save it as one file");
  }
  const std::string header_size = header.field({"headersize"});
  if (!header_size.empty() && header_size != "0") throw InvalidInput(file, "HeaderSize", "is not read");
  if (lower_case(header.field({"binarydata"})) == "false")
    throw InvalidInput(file, "BinaryData", "must be True");
  const std::size_t width = bytes_per(samples.type);
  const std::size_t bytes = width * checked_voxel_count(file, volume.size, width, most_bytes);
  std::string storage;
  std::string_view data = text.substr(header.bytes);
  if (data_name != "LOCAL") {
    storage = read_data_file(file, data_name, most_stored_bytes(bytes));
    data = storage;
  }
  if (header.is_true({"compresseddata"})) {
    storage = inflated(file, data, bytes);
    data = storage;
  }
  set_values(volume, file, data, samples);
  finish(volume, file);
  return volume;
}

}  // namespace arthronaut::images
