#include <cmath>
#include <optional>

#include "planning/geometry/error.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

struct Header {
  std::map<std::string, std::string> fields, pairs;  // "key: value" and "key:=value"
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
    if (line.front() == '#' || line_number == 1) continue;
    const auto colon = line.find(": ");
    if (const auto pair = line.find(":="); pair < colon) {
      header.pairs[line.substr(0, pair)] = trimmed(std::string_view(line).substr(pair + 2));
      continue;
    }
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

// 3D Slicer's segmentation: SegmentN_Name, SegmentN_LabelValue, and SegmentN_Layer where they overlap.
struct StoredSegment : Segment {
  int layer = 0;
};

std::vector<StoredSegment> segments_of(const std::filesystem::path& file, const Header& header) {
  constexpr std::size_t kMostSegments = 1000;
  std::vector<StoredSegment> segments;
  const auto whole = [&](const std::string& key, int absent) {
    const auto found = header.pairs.find(key);
    if (found == header.pairs.end()) return absent;
    const auto numbers = numbers_of(file, key, found->second);
    if (numbers.size() != 1 || numbers[0] != std::floor(numbers[0]) || std::abs(numbers[0]) > 65535)
      throw InvalidInput(file, key, "must be a whole number");
    return static_cast<int>(numbers[0]);
  };
  for (std::size_t i = 0; i < kMostSegments; ++i) {
    const std::string start = "Segment" + std::to_string(i) + "_";
    const auto name = header.pairs.find(start + "Name");
    if (name == header.pairs.end()) break;
    StoredSegment segment;
    segment.name = name->second;
    segment.label = whole(start + "LabelValue", static_cast<int>(i) + 1);
    segment.layer = whole(start + "Layer", 0);
    segments.push_back(segment);
  }
  return segments;
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

// Which axis of the file is the list of layers of a segmentation; -1 for a plain volume.
int list_axis(const std::filesystem::path& file, const Header& header) {
  const std::string dimension = header.field("dimension");
  if (dimension == "3") return -1;
  const std::string kinds = lower_case(header.field("kinds"));
  if (dimension == "4" && kinds.starts_with("list")) return 0;
  throw InvalidInput(file, "dimension", "is " + dimension.substr(0, 10) + ", expected 3");
}

// One label map of layers that lie voxel by voxel side by side: each segment gets a label of its own. Where
// segments overlap the last one counts.
void merge_layers(Volume& volume, const std::filesystem::path& file, std::size_t layer_count,
                  const std::vector<StoredSegment>& segments) {
  const std::size_t count = volume.values.size() / layer_count;
  std::vector<float> merged(count, 0);
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto layer = static_cast<std::size_t>(segments[s].layer);
    if (segments[s].layer < 0 || layer >= layer_count)
      throw InvalidInput(file, "Segment" + std::to_string(s) + "_Layer", "is not in the file");
    for (std::size_t v = 0; v < count; ++v) {
      if (volume.values[v * layer_count + layer] == static_cast<float>(segments[s].label))
        merged[v] = static_cast<float>(s + 1);
    }
    volume.segments.push_back({segments[s].name, static_cast<int>(s) + 1});
  }
  volume.values = std::move(merged);
  volume.notes.push_back("segments that overlap were laid over each other, the last on top");
}

// Of origin and directions. Without a word of it millimetres, as everywhere in medicine; so, too, where a
// unit is not told ("", "???").
double mm_per_unit(const std::filesystem::path& file, const std::string& space_units) {
  static const std::map<std::string, double> kLengths{{"um", 1e-3}, {"mm", 1}, {"cm", 10},
                                                      {"m", 1000},  {"", 1},   {"???", 1}};
  std::optional<double> mm;
  for (std::size_t at = space_units.find('"'); at != std::string::npos;) {
    const std::size_t end = space_units.find('"', at + 1);
    if (end == std::string::npos) throw InvalidInput(file, "space units", "a quotation mark is missing");
    const auto unit = kLengths.find(trimmed(lower_case(space_units.substr(at + 1, end - at - 1))));
    if (unit == kLengths.end() || unit->second != mm.value_or(unit->second))
      throw InvalidInput(file, "space units", "must be one length for all axes: um, mm, cm or m");
    mm = unit->second;
    at = space_units.find('"', end + 1);
  }
  return mm.value_or(1);
}

void read_axes(const std::filesystem::path& file, const Header& header, Volume& volume) {
  const Eigen::Vector3d scaled_signs =
      lps_from_space(file, header.field("space")) * mm_per_unit(file, header.field("space units"));
  std::string text = header.field("space directions");
  if (lower_case(text).starts_with("none")) text.erase(0, 4);
  const auto directions = numbers_of(file, "space directions", text);
  if (directions.size() != 9) throw InvalidInput(file, "space directions", "must hold 3 vectors");
  const std::string origin_text = header.field("space origin");
  const auto origin = numbers_of(file, "space origin", origin_text);
  if (origin.size() != 3) throw InvalidInput(file, "space origin", "must hold 3 numbers");
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 3; ++i) {
      volume.lps_from_index.linear()(i, axis) =
          scaled_signs[i] * directions[static_cast<std::size_t>(3 * axis + i)];
    }
    volume.lps_from_index.translation()[axis] = scaled_signs[axis] * origin[static_cast<std::size_t>(axis)];
  }
}

// Of the volume's axes; what remains is the number of layers.
std::size_t read_sizes(const std::filesystem::path& file, const Header& header, Volume& volume) {
  auto sizes = numbers_of(file, "sizes", header.field("sizes"));
  double layers = 1;
  if (list_axis(file, header) == 0 && sizes.size() == 4) {
    layers = sizes.front();
    sizes.erase(sizes.begin());
  }
  if (sizes.size() != 3) throw InvalidInput(file, "sizes", "must hold 3 numbers");
  const auto is_whole = [](double n) { return n >= 1 && n <= 65536 && n == std::floor(n); };
  if (!is_whole(layers) || layers > 1000) throw InvalidInput(file, "sizes", "are out of range");
  for (int i = 0; i < 3; ++i) {
    const double n = sizes[static_cast<std::size_t>(i)];
    if (!is_whole(n)) throw InvalidInput(file, "sizes", "are out of range");
    volume.size[i] = static_cast<int>(n);
  }
  return static_cast<std::size_t>(layers);
}

}  // namespace

std::vector<std::string> nrrd_segment_names(const std::filesystem::path& file, std::string_view text) {
  std::vector<std::string> names;
  for (const StoredSegment& segment : segments_of(file, parse_header(file, text)))
    names.push_back(segment.name);
  return names;
}

Volume parse_nrrd(const std::filesystem::path& file, std::string_view text, std::size_t most_bytes) {
  const Header header = parse_header(file, text);
  Volume volume;
  volume.format = "NRRD";
  const std::size_t layers = read_sizes(file, header, volume);
  read_axes(file, header, volume);
  Samples samples;
  samples.type = scalar_of(file, header.field("type"));
  const std::string endian = lower_case(header.field("endian"));
  if (endian == "big") {
    samples.order = std::endian::big;
  } else if (endian != "little" && bytes_per(samples.type) > 1) {
    throw InvalidInput(file, "endian", "must be little or big");
  }
  const std::size_t width = bytes_per(samples.type) * layers;
  const std::size_t count = checked_voxel_count(file, volume.size, width, most_bytes / layers);
  std::string storage;
  const std::string_view bytes = voxel_bytes(file, header, text, count * width, storage);
  const auto segments = segments_of(file, header);
  if (layers == 1) {
    set_values(volume, file, bytes, samples);
    volume.segments.assign(segments.begin(), segments.end());
  } else {
    // Layers run fastest: as one long row.
    const Eigen::Vector3i size = volume.size;
    volume.size.x() *= static_cast<int>(layers);
    set_values(volume, file, bytes, samples);
    volume.size = size;
    merge_layers(volume, file, layers, segments);
  }
  if (const auto modality = header.pairs.find("modality"); modality != header.pairs.end())
    volume.modality_in_file = modality->second.substr(0, 16);
  finish(volume, file);
  return volume;
}

}  // namespace arthronaut::images
