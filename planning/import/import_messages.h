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

namespace arthronaut::importing {

// To the child, once.
struct ChildRequest {
  std::filesystem::path source;
  BoneImportOptions options;
  std::uint64_t memory_limit_bytes = 0;
};

// From the child: progress any number of times, then a result or a failure.
enum class MessageKind : std::uint32_t { Request = 1, Progress, Result, Failure };

[[nodiscard]] std::string message_of(const ChildRequest& request);
[[nodiscard]] std::string message_of(const ImportProgress& progress);
[[nodiscard]] std::string message_of(const BoneImport& import);
[[nodiscard]] std::string failure_message(const std::string& reason);

struct Message {
  MessageKind kind = MessageKind::Request;
  std::string contents;
};
// The first whole message of the buffer, taken out of it; nullopt while it is not all there. Throws
// InvalidInput when the buffer begins with no message, or one longer than `most_bytes`.
[[nodiscard]] std::optional<Message> take_message(std::string& buffer, std::uint64_t most_bytes);

// Throw InvalidInput when the contents are not of that kind: cut off, a vertex that is not there.
[[nodiscard]] ChildRequest request_from(std::string_view contents);
[[nodiscard]] ImportProgress progress_from(std::string_view contents);
[[nodiscard]] BoneImport import_from(std::string_view contents);

}  // namespace arthronaut::importing
