#include "navigation/recording/open_formats.h"

#include <algorithm>

#include "navigation/recording/session_files.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

OpenFormats::Table::Table(const std::filesystem::path& named) : file(named), part(named.string() + ".part") {
  files::begin_private_file(part);
  stream.open(part, std::ios::binary | std::ios::trunc);
  check();
}

void OpenFormats::Table::check() const {
  if (!stream) throw IoError(file, "cannot write");
}

void OpenFormats::Table::finish() {
  stream.close();
  check();
  std::error_code error;
  std::filesystem::rename(part, file, error);
  if (error) throw IoError(file, "cannot write: " + error.message());
}

OpenFormats::OpenFormats(const std::filesystem::path& session_folder, const tools::ToolSet& tools)
    : tools_(tools), poses_(session_folder / "poses.csv"), guidance_(session_folder / "guidance.csv") {
  poses_.stream << strokes::kPosesHeader;
  guidance_.stream << kGuidanceHeader;
}

void OpenFormats::append(const pipeline::FrameResult& result) {
  rows_.clear();
  pipeline::append_pose_rows(result, rows_);
  // As the database gives them back.
  std::sort(rows_.begin(), rows_.end(),
            [](const strokes::PoseRow& a, const strokes::PoseRow& b) { return a.marker_id < b.marker_id; });
  poses_.text.clear();
  for (const strokes::PoseRow& row : rows_) strokes::append_pose_line(row, poses_.text);
  poses_.stream << poses_.text;
  guidance_.text.clear();
  append_guidance_line(result.frame_index, result.timestamp_ns, result.guidance, tools_, guidance_.text);
  guidance_.stream << guidance_.text;
}

void OpenFormats::flush() {
  for (Table* const table : {&poses_, &guidance_}) {
    table->stream.flush();
    table->check();
  }
}

void OpenFormats::finish() {
  poses_.finish();
  guidance_.finish();
}

}  // namespace arthronaut::recording
