#include "planning/import/import_messages.h"

#include <cstring>
#include <type_traits>

#include "planning/geometry/error.h"

namespace arthronaut::importing {

namespace {

constexpr std::uint32_t kMark = 0x41525448;

struct Header {
  std::uint32_t mark = kMark;
  MessageKind kind = MessageKind::Request;
  std::uint64_t length = 0;
};

// Writes or reads one value after another: describe() below is the one list of what a message holds.
class Writer {
 public:
  static constexpr bool kReads = false;
  void bytes(const void* from, std::size_t count) { text_.append(static_cast<const char*>(from), count); }
  // Of a list; writes it.
  std::size_t count(std::size_t count, std::size_t) {
    bytes(&count, sizeof(count));
    return count;
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

class Reader {
 public:
  static constexpr bool kReads = true;
  explicit Reader(std::string_view text) : text_(text) {}
  void bytes(void* to, std::size_t count) {
    if (text_.size() < count) throw InvalidInput("the importing process sent a message that is cut off");
    if (count > 0) std::memcpy(to, text_.data(), count);
    text_.remove_prefix(count);
  }
  // Refuses what the rest of the message cannot hold, before it is allocated.
  std::size_t count(std::size_t, std::size_t least_bytes_each) {
    std::size_t count = 0;
    bytes(&count, sizeof(count));
    if (count > text_.size() / least_bytes_each)
      throw InvalidInput("the importing process sent a message that is cut off");
    return count;
  }

 private:
  std::string_view text_;
};

template <typename Archive, typename T>
requires std::is_trivially_copyable_v<T>
void describe(Archive& archive, T& value) { archive.bytes(&value, sizeof(T)); }

// Any other byte than 0 and 1 would be no bool.
template <typename Archive>
void describe(Archive& archive, bool& value) {
  std::uint8_t byte = value ? 1 : 0;
  archive.bytes(&byte, 1);
  value = byte != 0;
}

template <typename Archive>
void describe(Archive& archive, std::string& value) {
  value.resize(archive.count(value.size(), 1));
  archive.bytes(value.data(), value.size());
}

template <typename Archive>
void describe(Archive& archive, std::filesystem::path& value) {
  std::string text = value.string();
  describe(archive, text);
  value = text;
}

template <typename Archive, typename T>
requires std::is_trivially_copyable_v<T>
void describe(Archive& archive, std::optional<T>& value) {
  bool has_value = value.has_value();
  describe(archive, has_value);
  if (!has_value) return;
  T held = value.value_or(T{});
  describe(archive, held);
  value = held;
}

template <typename Archive>
void describe(Archive& archive, std::vector<std::string>& lines) {
  lines.resize(archive.count(lines.size(), sizeof(std::size_t)));
  for (std::string& line : lines) describe(archive, line);
}

template <typename Archive>
void describe(Archive& archive, std::map<bones::BoneKind, int>& labels) {
  std::size_t left = archive.count(labels.size(), sizeof(bones::BoneKind) + sizeof(int));
  auto at = labels.begin();
  for (; left > 0; --left) {
    std::pair<bones::BoneKind, int> label;
    if constexpr (!Archive::kReads) label = *at++;
    describe(archive, label.first);
    describe(archive, label.second);
    labels.insert(label);
  }
}

template <typename Archive>
void describe(Archive& archive, geometry::TriangleMesh& mesh) {
  static_assert(sizeof(mesh.vertices_mm[0]) == 3 * sizeof(double));
  mesh.vertices_mm.resize(archive.count(mesh.vertices_mm.size(), 3 * sizeof(double)));
  if (!mesh.vertices_mm.empty())
    archive.bytes(mesh.vertices_mm.front().data(), mesh.vertices_mm.size() * 3 * sizeof(double));
  mesh.triangles.resize(archive.count(mesh.triangles.size(), sizeof(mesh.triangles[0])));
  archive.bytes(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
}

template <typename Archive>
void describe(Archive& archive, BoneImportOptions& options) {
  describe(archive, options.kind);
  describe(archive, options.side);
  describe(archive, options.space);
  describe(archive, options.unit);
  describe(archive, options.labels);
  describe(archive, options.threshold);
  describe(archive, options.series);
  describe(archive, options.most_bytes);
}

template <typename Archive>
void describe(Archive& archive, ChildRequest& request) {
  describe(archive, request.source);
  describe(archive, request.options);
  describe(archive, request.memory_limit_bytes);
}

template <typename Archive>
void describe(Archive& archive, ImportProgress& progress) {
  describe(archive, progress.stage);
  describe(archive, progress.fraction);
}

template <typename Archive>
void describe(Archive& archive, ImportedBone& imported) {
  describe(archive, imported.bone.kind);
  describe(archive, imported.bone.mesh);
  describe(archive, imported.bone.source);
  describe(archive, imported.repair);
  describe(archive, imported.lines);
  describe(archive, imported.doubts);
}

// The voxels go another way (shared_voxels.h).
template <typename Archive>
void describe(Archive& archive, std::optional<ImportedImage>& image) {
  bool has_value = image.has_value();
  describe(archive, has_value);
  if (!has_value) return;
  if (!image) image.emplace();
  describe(archive, image->image.modality);
  describe(archive, image->image.source);
  describe(archive, image->image.is_label_map);
  archive.bytes(image->image.size.data(), 3 * sizeof(int));
  archive.bytes(image->image.spacing_mm.data(), 3 * sizeof(double));
  describe(archive, image->volume.header);
}

template <typename Archive>
void describe(Archive& archive, BoneImport& import) {
  import.bones.resize(archive.count(import.bones.size(), sizeof(bones::MeshRepairReport)));
  for (ImportedBone& imported : import.bones) describe(archive, imported);
  describe(archive, import.side);
  describe(archive, import.side_was_guessed);
  describe(archive, import.side_was_seen);
  describe(archive, import.lines);
  describe(archive, import.identity.patient_name);
  describe(archive, import.identity.patient_id);
  describe(archive, import.identity.birth_date);
  describe(archive, import.image);
}

std::string framed(MessageKind kind, const std::string& contents) {
  const Header header{.kind = kind, .length = contents.size()};
  std::string message(sizeof(header), '\0');
  std::memcpy(message.data(), &header, sizeof(header));
  return message + contents;
}

template <typename T>
std::string written(MessageKind kind, const T& value) {
  Writer writer;
  T copy = value;  // describe() takes what it could write to
  describe(writer, copy);
  return framed(kind, writer.take());
}

template <typename T>
T read(std::string_view contents) {
  Reader reader(contents);
  T value;
  describe(reader, value);
  return value;
}

void refuse_unsound(const BoneImport& import) {
  if (import.side && *import.side != bones::Side::Left && *import.side != bones::Side::Right)
    throw InvalidInput("the importing process sent a side that is none");
  for (const ImportedBone& imported : import.bones) {
    const geometry::TriangleMesh& mesh = imported.bone.mesh;
    const auto count = static_cast<std::int64_t>(mesh.vertices_mm.size());
    bool is_sound =
        imported.bone.kind == bones::BoneKind::Femur || imported.bone.kind == bones::BoneKind::Tibia;
    for (const Eigen::Vector3d& p : mesh.vertices_mm) is_sound = is_sound && p.allFinite();
    for (const auto& triangle : mesh.triangles) {
      for (const std::int32_t corner : triangle) is_sound = is_sound && corner >= 0 && corner < count;
    }
    if (!is_sound) throw InvalidInput("the importing process sent a bone that is none");
  }
}

}  // namespace

std::string message_of(const ChildRequest& request) { return written(MessageKind::Request, request); }
std::string message_of(const ImportProgress& progress) { return written(MessageKind::Progress, progress); }
std::string message_of(const BoneImport& import) { return written(MessageKind::Result, import); }
std::string failure_message(const std::string& reason) { return framed(MessageKind::Failure, reason); }

std::optional<Message> take_message(std::string& buffer, std::uint64_t most_bytes) {
  Header header;
  if (buffer.size() < sizeof(header)) return std::nullopt;
  std::memcpy(&header, buffer.data(), sizeof(header));
  if (header.mark != kMark || header.length > most_bytes)
    throw InvalidInput("the importing process sent what is no message");
  if (buffer.size() - sizeof(header) < header.length) return std::nullopt;
  Message message{header.kind, buffer.substr(sizeof(header), header.length)};
  buffer.erase(0, sizeof(header) + header.length);
  return message;
}

ChildRequest request_from(std::string_view contents) { return read<ChildRequest>(contents); }
ImportProgress progress_from(std::string_view contents) { return read<ImportProgress>(contents); }
BoneImport import_from(std::string_view contents) {
  BoneImport import = read<BoneImport>(contents);
  refuse_unsound(import);
  return import;
}

}  // namespace arthronaut::importing
