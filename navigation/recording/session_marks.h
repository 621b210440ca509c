// What whoever looked at a session marked on its time line: marks.json in the session's folder, format
// "arthronaut.marks", version 1. It says nothing of what happened, and nothing is computed from it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace arthronaut::recording {

struct SessionMark {
  std::int64_t frame = 0;  // its index in the session
  std::int64_t timestamp_ns = 0;
  std::string note;  // no patient's name belongs here; may be empty
  bool operator==(const SessionMark&) const = default;
};
using SessionMarks = std::vector<SessionMark>;  // by frame, one a frame

[[nodiscard]] std::filesystem::path marks_file(const std::filesystem::path& session_folder);
// None where there is no file. Throws IoError or InvalidInput.
[[nodiscard]] SessionMarks read_marks(const std::filesystem::path& session_folder);
// Atomic; private as the case is. Throws IoError; what was there is then as before.
void write_marks(const std::filesystem::path& session_folder, const SessionMarks& marks);

// With the mark, in the place of one at the same frame. A pure function.
[[nodiscard]] SessionMarks with_mark(SessionMarks marks, const SessionMark& mark);
// Without the one at that frame; as it was when there is none.
[[nodiscard]] SessionMarks without_mark(SessionMarks marks, std::int64_t frame);

}  // namespace arthronaut::recording
