#include "navigation/sources/matroska_end.h"

#include <algorithm>
#include <cstdint>
#include <fstream>

namespace arthronaut::sources {
namespace {

constexpr std::uint64_t kEbmlId = 0x1A45DFA3, kSegmentId = 0x18538067, kClusterId = 0x1F43B675,
                        kTimeId = 0xE7;

// Walks element headers. EBML numbers carry their own length in the leading zero bits of the first byte.
class ElementReader {
 public:
  explicit ElementReader(const std::filesystem::path& file) : stream_(file, std::ios::binary) {
    stream_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(0, stream_.tellg()));
    stream_.seekg(0);
  }

  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] std::uint64_t position() { return static_cast<std::uint64_t>(stream_.tellg()); }
  void seek(std::uint64_t position) { stream_.seekg(static_cast<std::streamoff>(position)); }

  // False when the file ends inside the number.
  bool read_id(std::uint64_t& id) { return read_number(id, false); }
  // As many bytes, the first one highest.
  bool read_bytes(std::uint64_t& value, std::uint64_t count) {
    value = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const int next = stream_.get();
      if (next < 0) return false;
      value = (value << 8) | static_cast<std::uint64_t>(next);
    }
    return true;
  }
  // all_ones: the size is not known (a live recording).
  bool read_size(std::uint64_t& size, bool& all_ones) {
    if (!read_number(size, true)) return false;
    all_ones = size == (std::uint64_t{1} << (7 * length_)) - 1;
    return true;
  }

 private:
  bool read_number(std::uint64_t& value, bool drop_length_bit) {
    const int first = stream_.get();
    if (first <= 0) return false;
    length_ = 1;
    while (!(first & (0x80 >> (length_ - 1)))) ++length_;
    value = static_cast<std::uint64_t>(drop_length_bit ? first & (0xFF >> length_) : first);
    for (int i = 1; i < length_; ++i) {
      const int next = stream_.get();
      if (next < 0) return false;
      value = (value << 8) | static_cast<std::uint64_t>(next);
    }
    return true;
  }

  std::ifstream stream_;
  std::uint64_t size_ = 0;
  int length_ = 0;
};

}  // namespace

bool matroska_breaks_off(const std::filesystem::path& file) {
  ElementReader reader(file);
  std::uint64_t id = 0, size = 0;
  bool unknown_size = false;
  if (!reader.read_id(id) || id != kEbmlId) return false;
  reader.seek(0);
  while (reader.position() < reader.size()) {
    if (!reader.read_id(id) || !reader.read_size(size, unknown_size)) return true;
    const std::uint64_t body = reader.position();
    if (!unknown_size && size > reader.size() - body) return true;
    // Segments and clusters are entered, so that a live recording, whose sizes are not known, is checked
    // block by block.
    const bool enter = unknown_size || id == kSegmentId || id == kClusterId;
    reader.seek(enter ? body : body + size);
  }
  return false;
}

bool matroska_is_unfinished(const std::filesystem::path& file) {
  ElementReader reader(file);
  std::uint64_t id = 0, size = 0;
  bool unknown_size = false;
  if (!reader.read_id(id) || id != kEbmlId || !reader.read_size(size, unknown_size)) return false;
  reader.seek(reader.position() + size);
  if (!reader.read_id(id) || id != kSegmentId || !reader.read_size(size, unknown_size)) return false;
  return unknown_size || size > reader.size() - reader.position();
}

std::vector<MatroskaCluster> matroska_clusters(const std::filesystem::path& file) {
  std::vector<MatroskaCluster> clusters;
  ElementReader reader(file);
  std::uint64_t id = 0, size = 0;
  bool unknown_size = false;
  if (!reader.read_id(id) || id != kEbmlId) return clusters;
  reader.seek(0);
  std::uint64_t start = 0, skip_to = 0;  // of the cluster that is in hand
  bool awaits_time = false;
  while (reader.position() < reader.size()) {
    const std::uint64_t at = reader.position();
    if (!reader.read_id(id) || !reader.read_size(size, unknown_size)) break;
    const std::uint64_t body = reader.position();
    if (id == kSegmentId) continue;
    if (id == kClusterId) {
      start = at;
      awaits_time = true;
      skip_to = unknown_size ? 0 : body + size;
      continue;
    }
    if (awaits_time && id == kTimeId && size <= 8) {
      std::uint64_t time = 0;
      if (!reader.read_bytes(time, size)) break;
      clusters.push_back({static_cast<std::int64_t>(start), static_cast<std::int64_t>(time)});
      awaits_time = false;
      if (skip_to > 0) reader.seek(skip_to);  // its blocks are not looked at
      continue;
    }
    if (unknown_size || size > reader.size() - body) break;
    reader.seek(body + size);
  }
  return clusters;
}

}  // namespace arthronaut::sources
