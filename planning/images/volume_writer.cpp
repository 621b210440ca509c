#include "planning/images/volume_writer.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <new>
#include <vector>

#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::images {

namespace {

struct Range {
  bool is_whole = true;
  float low = 0, high = 0;
};

Range range_of(const std::vector<float>& values) {
  Range range;
  if (values.empty()) return range;
  range.low = range.high = values.front();
  for (const float v : values) {
    range.low = std::min(range.low, v);
    range.high = std::max(range.high, v);
    if (v != std::floor(v)) range.is_whole = false;
  }
  return range;
}

template <typename T>
void fill(EncodedVolume& encoded, const std::vector<float>& values) {
  const auto voxels = std::make_shared<std::vector<T>>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) (*voxels)[i] = static_cast<T>(values[i]);
  encoded.voxels = {reinterpret_cast<const char*>(voxels->data()), voxels->size() * sizeof(T)};
  encoded.owner = voxels;
}

std::string vector_text(const Eigen::Vector3d& v) {
  return files::format("(%.17g,%.17g,%.17g)", v.x(), v.y(), v.z());
}

// What a line of the header may hold.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\0'; }, ' ');
  return text;
}

std::string header_of(const Volume& volume, const char* type, const char* encoding,
                      const std::string& modality, const std::vector<Segment>& segments) {
  const Eigen::Matrix3d axes = volume.lps_from_index.linear();
  std::string header =
      std::string("NRRD0004\ntype: ") + type + "\ndimension: 3\nspace: left-posterior-superior\nsizes: " +
      files::format("%d %d %d", volume.size.x(), volume.size.y(), volume.size.z()) +
      "\nspace directions: " + vector_text(axes.col(0)) + " " + vector_text(axes.col(1)) + " " +
      vector_text(axes.col(2)) + "\nkinds: domain domain domain\nendian: " +
      (std::endian::native == std::endian::little ? "little" : "big") + "\nencoding: " + encoding +
      "\nspace origin: " + vector_text(volume.lps_from_index.translation()) + "\n";
  if (!modality.empty()) header += "modality:=" + one_line(modality) + "\n";
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::string start = "Segment" + std::to_string(i) + "_";
    header += start + "Name:=" + one_line(segments[i].name) + "\n" + start +
              "LabelValue:=" + std::to_string(segments[i].label) + "\n";
  }
  return header + "\n";
}

// The fastest level: nearly all of a label map is one value.
std::shared_ptr<std::string> packed(std::span<const std::uint8_t> bytes) {
  constexpr int kLevel = 1, kWindowWithGzipHeader = 15 + 16, kMemory = 8;
  constexpr std::size_t kStep = std::size_t{1} << 30;  // zlib counts in 32 bits
  z_stream stream{};
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, kWindowWithGzipHeader, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  auto result = std::make_shared<std::string>();
  std::vector<Bytef> chunk(std::size_t{1} << 18);
  do {
    const std::size_t step = std::min(bytes.size(), kStep);
    stream.next_in = const_cast<Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(step);
    bytes = bytes.subspan(step);
    do {
      stream.next_out = chunk.data();
      stream.avail_out = static_cast<uInt>(chunk.size());
      deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
      result->append(reinterpret_cast<const char*>(chunk.data()), chunk.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  } while (!bytes.empty());
  deflateEnd(&stream);
  return result;
}

}  // namespace

EncodedVolume encoded_labels(const Volume& grid, std::span<const std::uint8_t> labels,
                             const std::vector<Segment>& segments) {
  if (labels.size() != static_cast<std::size_t>(grid.size.cast<std::int64_t>().prod()))
    throw InvalidInput("the labels are not of the volume's size");
  const auto voxels = packed(labels);
  return {header_of(grid, "uint8", "gzip", "", segments), *voxels, voxels};
}

EncodedVolume encoded(const Volume& volume) {
  EncodedVolume encoded;
  const Range range = range_of(volume.values);
  const char* type = "float";
  if (range.is_whole && range.low >= 0 && range.high <= 255) {
    type = "uint8";
    fill<std::uint8_t>(encoded, volume.values);
  } else if (range.is_whole && range.low >= -32768 && range.high <= 32767) {
    type = "int16";
    fill<std::int16_t>(encoded, volume.values);
  } else {
    fill<float>(encoded, volume.values);
  }
  encoded.header = header_of(volume, type, "raw", volume.modality_in_file, volume.segments);
  return encoded;
}

void write_volume(const std::filesystem::path& file, const EncodedVolume& volume) {
  files::write_atomically(file, [&](const std::filesystem::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    stream.write(volume.header.data(), static_cast<std::streamsize>(volume.header.size()));
    stream.write(volume.voxels.data(), static_cast<std::streamsize>(volume.voxels.size()));
    stream.close();
    if (!stream) throw IoError(temporary, "cannot be written: the disk may be full");
  });
}

void write_volume(const std::filesystem::path& file, const Volume& volume) {
  write_volume(file, encoded(volume));
}

}  // namespace arthronaut::images
