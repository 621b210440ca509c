// Where things lie in a case folder.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "planning/cases/case.h"
#include "planning/files/format.h"
#include "planning/files/private_folder.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::cases {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kLargestNumber = 1'000'000'000;  // a name with more digits is no session's

// Two programs that make a session's folder at the same moment must not find the same number. Where the file
// system cannot lock folders the lock of the case (case_lock.h) is what keeps them apart.
class OneAtATime {
 public:
  explicit OneAtATime(const fs::path& folder)
      : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ >= 0) (void)::flock(descriptor_, LOCK_EX);
  }
  ~OneAtATime() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OneAtATime(const OneAtATime&) = delete;
  OneAtATime& operator=(const OneAtATime&) = delete;

 private:
  int descriptor_;
};

}  // namespace

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

std::int64_t session_number(const fs::path& session_folder) {
  const std::string name = session_folder.filename().string();
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto first = std::find_if_not(name.begin(), name.end(), is_digit);
  if (first == name.begin() || first == name.end() || *first != '-') return 0;
  // A date of eight digits follows a number; what follows the date of an older folder is a time of six.
  const auto second = std::find_if_not(first + 1, name.end(), is_digit);
  if (second - (first + 1) != 8) return 0;
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + (first - name.begin()), number);
  return error == std::errc() && number < kLargestNumber ? number : 0;
}

std::vector<fs::path> session_folders(const fs::path& case_folder) {
  std::vector<std::pair<std::int64_t, fs::path>> numbered;
  const fs::path sessions = case_folder / "sessions";
  if (!fs::is_directory(sessions)) return {};
  for (const auto& entry : fs::directory_iterator(sessions)) {
    if (entry.is_directory()) numbered.emplace_back(session_number(entry.path()), entry.path());
  }
  std::sort(numbered.begin(), numbered.end());
  std::vector<fs::path> folders;
  for (auto& [number, folder] : numbered) folders.push_back(std::move(folder));
  return folders;
}

fs::path create_session_folder(const fs::path& case_folder) {
  const fs::path sessions = case_folder / "sessions";
  files::create_private_folder(sessions);
  const OneAtATime turn(sessions);
  const auto there = session_folders(case_folder);
  const std::int64_t number = there.empty() ? 1 : session_number(there.back()) + 1;
  const fs::path folder = sessions / files::format("%04lld-%s", static_cast<long long>(number),
                                                   files::utc_now_as("%Y%m%d-%H%M%S").c_str());
  if (::mkdir(folder.c_str(), S_IRWXU) != 0)
    throw IoError(folder, std::string("cannot create: ") + std::strerror(errno));
  return folder;
}

}  // namespace arthronaut::cases
