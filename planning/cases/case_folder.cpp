// Where things lie in a case folder.
#include <algorithm>
#include <chrono>
#include <ctime>

#include "planning/cases/case.h"
#include "planning/geometry/error.h"

namespace arthronaut::cases {

namespace fs = std::filesystem;

fs::path camera_file(const fs::path& case_folder) { return case_folder / "camera.json"; }
fs::path tools_file(const fs::path& case_folder) { return case_folder / "tools.json"; }

fs::path mesh_file(const fs::path& case_folder, bones::BoneKind kind) {
  return case_folder / (std::string(bones::to_text(kind)) + ".ply");
}

fs::path surface_index_file(const fs::path& case_folder, bones::BoneKind kind) {
  return case_folder / "cache" / (std::string(bones::to_text(kind)) + ".prepared");
}

fs::path cartilage_file(const fs::path& case_folder, bones::BoneKind kind) {
  return case_folder / (std::string(bones::to_text(kind)) + "_cartilage.ply");
}

std::vector<fs::path> session_folders(const fs::path& case_folder) {
  std::vector<fs::path> folders;
  const fs::path sessions = case_folder / "sessions";
  if (!fs::is_directory(sessions)) return folders;
  for (const auto& entry : fs::directory_iterator(sessions)) {
    if (entry.is_directory()) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

std::string utc_now() {
  char text[32];
  std::tm utc{};
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  gmtime_r(&now, &utc);
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

fs::path create_session_folder(const fs::path& case_folder) {
  std::error_code error;
  fs::create_directories(case_folder / "sessions", error);
  if (error) throw IoError(case_folder / "sessions", "cannot create: " + error.message());
  char name[32];
  std::tm utc{};
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  gmtime_r(&now, &utc);
  std::strftime(name, sizeof name, "%Y%m%d-%H%M%S", &utc);
  // Two sessions within a second differ by a counter that still sorts. create_directory tells who came first.
  for (int counter = 0; counter < 1000; ++counter) {
    char suffix[8] = "";
    if (counter > 0) std::snprintf(suffix, sizeof suffix, "-%03d", counter);
    const fs::path folder = case_folder / "sessions" / (std::string(name) + suffix);
    if (fs::create_directory(folder, error)) return folder;
    if (error) throw IoError(folder, "cannot create: " + error.message());
  }
  throw IoError(case_folder / "sessions", "holds a thousand sessions of this second");
}

}  // namespace arthronaut::cases
