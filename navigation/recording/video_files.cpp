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

// The stills of a printf pattern, in no order. Throws IoError.
std::vector<fs::path> stills_of(const fs::path& pattern) {
  const std::string name = pattern.filename().string();
  const std::size_t percent = name.find('%');
  const std::size_t letter = percent == std::string::npos ? percent : name.find('d', percent);
  if (letter == std::string::npos) throw IoError(pattern, "no such video");
  std::vector<fs::path> stills;
  for (const auto& entry : fs::directory_iterator(pattern.has_parent_path() ? pattern.parent_path() : "."))
    if (matches(entry.path().filename().string(), name.substr(0, percent), name.substr(letter + 1)))
      stills.push_back(entry.path());
  return stills;
}

}  // namespace

std::uintmax_t video_bytes(const fs::path& video_or_pattern) {
  std::uintmax_t bytes = 0;
  const auto add = [&bytes](const fs::path& file) {
    std::error_code error;  // what cannot be read is said when it is copied
    const std::uintmax_t size = fs::file_size(file, error);
    if (!error) bytes += size;
  };
  if (fs::exists(video_or_pattern)) {
    add(video_or_pattern);
  } else {
    for (const fs::path& still : stills_of(video_or_pattern)) add(still);
  }
  return bytes;
}

std::string copy_video_into(const fs::path& session_folder, const fs::path& video_or_pattern) {
  if (fs::exists(video_or_pattern)) {
    const std::string name = "video" + video_or_pattern.extension().string();
    copy_one(video_or_pattern, session_folder / name);
    return name;
  }
  const fs::path pictures = session_folder / "pictures";
  const std::vector<fs::path> stills = stills_of(video_or_pattern);
  fs::create_directory(pictures);
  try {
    for (const fs::path& still : stills) copy_one(still, pictures / still.filename());
  } catch (const IoError&) {
    std::error_code ignored;
    fs::remove_all(pictures, ignored);  // a part of them would pass for all
    throw;
  }
  return "pictures/" + video_or_pattern.filename().string();
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
