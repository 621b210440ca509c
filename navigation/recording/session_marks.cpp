#include "navigation/recording/session_marks.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "planning/files/json_document.h"

namespace arthronaut::recording {

namespace {

constexpr const char* kMarksFormat = "arthronaut.marks";
constexpr int kMarksVersion = 1;

}  // namespace

std::filesystem::path marks_file(const std::filesystem::path& session_folder) {
  return session_folder / "marks.json";
}

SessionMarks read_marks(const std::filesystem::path& session_folder) {
  const std::filesystem::path file = marks_file(session_folder);
  SessionMarks marks;
  if (!std::filesystem::exists(file)) return marks;
  for (const files::JsonObject& node : files::read_json(file, kMarksFormat, kMarksVersion).objects("marks"))
    marks =
        with_mark(std::move(marks), {node.integer("frame"), node.integer("timestamp_ns"), node.text("note")});
  return marks;
}

void write_marks(const std::filesystem::path& session_folder, const SessionMarks& marks) {
  nlohmann::ordered_json json;
  json["format"] = kMarksFormat;
  json["version"] = kMarksVersion;
  json["marks"] = nlohmann::ordered_json::array();
  for (const SessionMark& mark : marks) {
    json["marks"].push_back(
        {{"frame", mark.frame}, {"timestamp_ns", mark.timestamp_ns}, {"note", mark.note}});
  }
  files::write_json(marks_file(session_folder), json);
}

SessionMarks with_mark(SessionMarks marks, const SessionMark& mark) {
  const auto at =
      std::lower_bound(marks.begin(), marks.end(), mark.frame,
                       [](const SessionMark& one, std::int64_t frame) { return one.frame < frame; });
  if (at != marks.end() && at->frame == mark.frame)
    *at = mark;
  else
    marks.insert(at, mark);
  return marks;
}

SessionMarks without_mark(SessionMarks marks, std::int64_t frame) {
  std::erase_if(marks, [&](const SessionMark& mark) { return mark.frame == frame; });
  return marks;
}

}  // namespace arthronaut::recording
