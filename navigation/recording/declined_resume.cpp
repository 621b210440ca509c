#include "navigation/recording/declined_resume.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "navigation/recording/case_sessions.h"
#include "navigation/recording/session_facts.h"
#include "navigation/recording/session_files.h"
#include "planning/cases/case.h"
#include "planning/files/json_document.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

std::filesystem::path declined_file(const std::filesystem::path& session_folder) {
  return session_folder / "declined.json";
}

// A file that nobody can read was written for that alone.
bool is_resume_declined(const std::filesystem::path& session_folder) {
  std::error_code none;
  return std::filesystem::exists(declined_file(session_folder), none);
}

bool can_be_taken_back(const std::filesystem::path& case_folder,
                       const std::filesystem::path& session_folder) {
  if (!is_resume_declined(session_folder)) return false;
  std::vector<std::filesystem::path> folders = cases::session_folders(case_folder);
  std::reverse(folders.begin(), folders.end());
  std::optional<bones::BoneKind> bone;
  try {
    pipeline::PipelineOptions options;
    bone = read_session_header(session_folder, options).bone;
  } catch (const std::runtime_error&) {
    return false;
  }
  for (const std::filesystem::path& folder : folders) {
    if (folder.filename() == session_folder.filename()) return true;
    try {  // passed over as find_resumable() does
      pipeline::PipelineOptions options;
      const SessionHeader header = read_session_header(folder, options);
      if (header.bone != *bone || is_exercise(header)) continue;
      // Without a frame, or where nothing tells of one, it decides nothing.
      if (read_session_facts(folder).length_min || !header.continues.empty()) return false;
    } catch (const std::runtime_error&) {
      continue;
    }
  }
  return false;
}

void decline_resume(const std::filesystem::path& session_folder) {
  nlohmann::ordered_json json;
  json["format"] = "arthronaut.declined";
  json["version"] = 1;
  json["declined_utc"] = files::utc_now();
  files::write_json(declined_file(session_folder), json);
}

void take_back_declined_resume(const std::filesystem::path& session_folder) {
  std::error_code error;
  std::filesystem::remove(declined_file(session_folder), error);
  if (error) throw IoError(declined_file(session_folder), error.message());
}

}  // namespace arthronaut::recording
