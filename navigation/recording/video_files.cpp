#include "navigation/recording/video_files.h"

#include <algorithm>
#include <cstdio>

#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

namespace fs = std::filesystem;

void copy_one(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy_file(from, to, error);
  if (!error && files::is_private(to.parent_path())) files::make_private(to);
  if (!error) return;
  std::error_code ignored;
  fs::remove(to, ignored);  // half a video would pass for a whole one
  throw IoError(to, "cannot copy the video: " + error.message());
}

// Whether `name` is one that the pattern's "%d" or "%0Nd" makes.
bool matches(const std::string& name, const std::string& head, const std::string& tail) {
  if (name.size() <= head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail))
    return false;
  const std::string number = name.substr(head.size(), name.size() - head.size() - tail.size());
  return number.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

std::string copy_video_into(const fs::path& session_folder, const fs::path& video_or_pattern) {
  if (fs::exists(video_or_pattern)) {
    const std::string name = "video" + video_or_pattern.extension().string();
    copy_one(video_or_pattern, session_folder / name);
    return name;
  }
  const std::string pattern = video_or_pattern.filename().string();
  const std::size_t percent = pattern.find('%');
  const std::size_t letter = percent == std::string::npos ? percent : pattern.find('d', percent);
  if (letter == std::string::npos) throw IoError(video_or_pattern, "no such video");
  const fs::path from = video_or_pattern.has_parent_path() ? video_or_pattern.parent_path() : fs::path(".");
  fs::create_directory(session_folder / "pictures");
  for (const fs::directory_entry& entry : fs::directory_iterator(from)) {
    const std::string name = entry.path().filename().string();
    if (matches(name, pattern.substr(0, percent), pattern.substr(letter + 1))) {
      copy_one(entry.path(), session_folder / "pictures" / name);
    }
  }
  return "pictures/" + pattern;
}

std::vector<std::string> video_files(const fs::path& session_folder, const std::string& video) {
  if (fs::exists(session_folder / video)) return {video};
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(session_folder / "pictures"))
    names.push_back("pictures/" + entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace arthronaut::recording
