// What the import's two processes say to each other. Inner header of import.
//
// Both are the same program on the same machine, so numbers travel as they lie in memory. The child reads
// files from anywhere, so the parent believes none of its lengths and indices.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "planning/import/bone_import.h"
#include "planning/import/series_process.h"

namespace arthronaut::importing {

enum class ChildWork : std::uint32_t {
  MakeBones = 1,
  ReadPostop,  // as postop::read_postop(), with the series of the options; a result without bones
  ListSeries,
  ListSeriesWithPictures
};

// To the child, once.
struct ChildRequest {
  ChildWork work = ChildWork::MakeBones;
  std::filesystem::path source;
  BoneImportOptions options;  // of the bones
  std::uint64_t memory_limit_bytes = 0;
};

// From the child. Bones: progress any number of times, then a result. Series: progress, the list, then a
// picture for each series of it where they are asked for. A failure ends both, at any time.
enum class MessageKind : std::uint32_t { Request = 1, Progress, Result, Failure, SeriesList, SeriesPicture };

// Of 50 000 files it is a few MB.
inline constexpr std::uint64_t kLongestList_bytes = 64ULL << 20;

[[nodiscard]] std::string message_of(const ChildRequest& request);
[[nodiscard]] std::string message_of(const ImportProgress& progress);
[[nodiscard]] std::string message_of(const BoneImport& import);
[[nodiscard]] std::string message_of(const images::SeriesList& list);
[[nodiscard]] std::string message_of(const SeriesPicture& picture);
[[nodiscard]] std::string message_of(const Failure& failure);

struct Message {
  MessageKind kind = MessageKind::Request;
  std::string contents;
};
// The first whole message of the buffer, taken out of it; nullopt while it is not all there. Throws
// InvalidInput when the buffer begins with no message, or one longer than `most_bytes`.
[[nodiscard]] std::optional<Message> take_message(std::string& buffer, std::uint64_t most_bytes);

// Throw InvalidInput when the contents are not of that kind: cut off, a vertex that is not there, a picture
// of another size than its pixels.
[[nodiscard]] ChildRequest request_from(std::string_view contents);
[[nodiscard]] ImportProgress progress_from(std::string_view contents);
[[nodiscard]] BoneImport import_from(std::string_view contents);
[[nodiscard]] images::SeriesList series_list_from(std::string_view contents);
[[nodiscard]] Failure failure_from(std::string_view contents);
[[nodiscard]] SeriesPicture series_picture_from(std::string_view contents);

}  // namespace arthronaut::importing
