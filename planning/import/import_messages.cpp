#include "planning/import/import_messages.h"

#include <cstring>
#include <type_traits>

#include "planning/geometry/error.h"
#include "planning/import/message_archive.h"
#include "planning/import/message_limits.h"

namespace arthronaut::importing {

namespace {

constexpr std::uint32_t kMark = 0x41525448;

struct Header {
  std::uint32_t mark = kMark;
  MessageKind kind = MessageKind::Request;
  std::uint64_t length = 0;
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

// What one of a list takes in a message at the least. A text, and whatever begins with one: its length.
template <typename T>
constexpr std::size_t kLeastBytes = sizeof(std::size_t);
template <>
constexpr std::size_t kLeastBytes<images::SkippedFile> = 2 * sizeof(std::size_t);
template <>
constexpr std::size_t kLeastBytes<images::ImageSeries> = 8 * sizeof(std::size_t) + 4 * sizeof(int) +
                                                         3 * sizeof(double);
template <>
constexpr std::size_t kLeastBytes<ImportedBone> = sizeof(bones::MeshRepairReport);
template <>
constexpr std::size_t kLeastBytes<bones::FilledHole> = 7 * sizeof(double);
template <>
constexpr std::size_t kLeastBytes<bones::ImageCut> = 7 * sizeof(double);
template <>
constexpr std::size_t kLeastBytes<bones::LengthUnit> = sizeof(bones::LengthUnit);
template <>
constexpr std::size_t kLeastBytes<FoundLabel> = sizeof(std::int32_t) + 7 * sizeof(double);

// Below, where all that a list may hold is known.
template <typename Archive, typename T>
void describe(Archive& archive, std::vector<T>& values);

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
  describe(archive, options.images_only);
  describe(archive, options.edges_in);
  describe(archive, options.needs_side);
  describe(archive, options.most_bytes);
}

template <typename Archive>
void describe(Archive& archive, ChildRequest& request) {
  describe(archive, request.work);
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
void describe(Archive& archive, bones::FilledHole& hole) {
  archive.bytes(hole.at_mm.data(), 3 * sizeof(double));
  describe(archive, hole.across_mm);
  archive.bytes(hole.out.data(), 3 * sizeof(double));
}

template <typename Archive>
void describe(Archive& archive, bones::ImageCut& cut) {
  archive.bytes(cut.at_mm.data(), 3 * sizeof(double));
  archive.bytes(cut.out.data(), 3 * sizeof(double));
  describe(archive, cut.area_mm2);
}

template <typename Archive>
void describe(Archive& archive, ImportedBone& imported) {
  describe(archive, imported.bone.kind);
  describe(archive, imported.bone.mesh);
  describe(archive, imported.bone.source);
  describe(archive, imported.repair);
  describe(archive, imported.lines);
  describe(archive, imported.doubts);
  describe(archive, imported.filled_holes);
  describe(archive, imported.image_cuts);
  describe(archive, imported.read_in);
  describe(archive, imported.looks_backwards);
  describe(archive, imported.shape_was_judged);
  describe(archive, imported.side_by_shape);
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
void describe(Archive& archive, images::DicomOrigin& origin) {
  for (std::string* text :
       {&origin.study_uid, &origin.study_id, &origin.accession_number, &origin.referring_physician,
        &origin.study_date, &origin.study_time, &origin.patient_sex, &origin.patient_id_issuer,
        &origin.series_uid, &origin.frame_of_reference_uid, &origin.sop_class_uid})
    describe(archive, *text);
  describe(archive, origin.sop_instance_uids);
}

template <typename Archive>
void describe(Archive& archive, BoneImport& import) {
  describe(archive, import.bones);
  describe(archive, import.side);
  describe(archive, import.side_source);
  describe(archive, import.side_by_fibula);
  describe(archive, import.side_in_images);
  describe(archive, import.why_no_side);
  describe(archive, import.lines);
  describe(archive, import.identity.patient_name);
  describe(archive, import.identity.patient_id);
  describe(archive, import.identity.birth_date);
  describe(archive, import.origin);
  describe(archive, import.image);
}

template <typename Archive>
void describe(Archive& archive, FoundLabel& label) {
  describe(archive, label.label);
  describe(archive, label.volume_cm3);
  archive.bytes(label.lowest_mm.data(), 3 * sizeof(double));
  archive.bytes(label.highest_mm.data(), 3 * sizeof(double));
}

template <typename Archive>
void describe(Archive& archive, Failure& failure) {
  describe(archive, failure.reason);
  describe(archive, failure.words);
  describe(archive, failure.size_in_file);
  describe(archive, failure.units);
  describe(archive, failure.labels);
}

template <typename Archive>
void describe(Archive& archive, images::ImageSeries& series) {
  describe(archive, series.uid);
  describe(archive, series.number);
  describe(archive, series.format);
  describe(archive, series.modality);
  describe(archive, series.description);
  describe(archive, series.patient_name);
  describe(archive, series.patient_id);
  describe(archive, series.study_date);
  describe(archive, series.image_count);
  archive.bytes(series.size.data(), 3 * sizeof(int));
  archive.bytes(series.spacing_mm.data(), 3 * sizeof(double));
  describe(archive, series.files);
  describe(archive, series.refusal);
  describe(archive, series.warnings);
}

template <typename Archive>
void describe(Archive& archive, images::SkippedFile& skipped) {
  describe(archive, skipped.file);
  describe(archive, skipped.reason);
}

template <typename Archive>
void describe(Archive& archive, images::SeriesList& list) {
  describe(archive, list.series);
  describe(archive, list.skipped);
  describe(archive, list.other_count);
}

template <typename Archive>
void describe(Archive& archive, SeriesPicture& picture) {
  images::Thumbnail& thumbnail = picture.thumbnail;
  describe(archive, thumbnail.width);
  describe(archive, thumbnail.height);
  thumbnail.grey.resize(archive.count(thumbnail.grey.size(), 1));
  archive.bytes(thumbnail.grey.data(), thumbnail.grey.size());
  describe(archive, picture.refusal);
}

template <typename Archive, typename T>
void describe(Archive& archive, std::vector<T>& values) {
  values.resize(archive.count(values.size(), kLeastBytes<T>));
  for (T& value : values) describe(archive, value);
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
  reader.refuse_rest();
  return value;
}

template <typename T>
T sound(std::string_view contents) {
  T value = read<T>(contents);
  refuse_unsound(value);
  return value;
}

}  // namespace

std::string message_of(const ChildRequest& request) { return written(MessageKind::Request, request); }
std::string message_of(const ImportProgress& progress) { return written(MessageKind::Progress, progress); }
std::string message_of(const BoneImport& import) { return written(MessageKind::Result, import); }
std::string message_of(const images::SeriesList& list) {
  images::SeriesList shown = list;
  clip_texts(shown);
  return written(MessageKind::SeriesList, shown);
}
std::string message_of(const SeriesPicture& picture) {
  return written(MessageKind::SeriesPicture, SeriesPicture{picture.thumbnail, clipped(picture.refusal)});
}
std::string message_of(const Failure& failure) {
  Failure shown = failure;
  shown.words = clipped(std::move(shown.words));
  return written(MessageKind::Failure, shown);
}

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
ImportProgress progress_from(std::string_view contents) { return sound<ImportProgress>(contents); }
BoneImport import_from(std::string_view contents) { return sound<BoneImport>(contents); }
images::SeriesList series_list_from(std::string_view contents) { return sound<images::SeriesList>(contents); }
Failure failure_from(std::string_view contents) { return sound<Failure>(contents); }
SeriesPicture series_picture_from(std::string_view contents) { return sound<SeriesPicture>(contents); }

}  // namespace arthronaut::importing
