#include "planning/files/private_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "planning/geometry/error.h"

namespace arthronaut::files {

namespace {

namespace fs = std::filesystem;
constexpr mode_t kOfOthers = S_IRWXG | S_IRWXO;

// lstat: a link in a case must not change the rights of what it leads to.
void take_rights_of_others(const fs::path& entry) {
  struct stat status {};
  if (::lstat(entry.c_str(), &status) != 0 || S_ISLNK(status.st_mode)) return;
  if (status.st_uid != ::geteuid() || (status.st_mode & kOfOthers) == 0) return;
  // What cannot be changed stays as it is: the file system knows no rights, or is read-only.
  (void)::fchmodat(AT_FDCWD, entry.c_str(), status.st_mode & 07777 & ~kOfOthers, 0);
}

}  // namespace

void create_private_folder(const fs::path& folder) {
  std::error_code error;
  if (folder.has_parent_path()) fs::create_directories(folder.parent_path(), error);
  if (error) throw IoError(folder, "cannot create: " + error.message());
  if (::mkdir(folder.c_str(), S_IRWXU) == 0) return;
  const int reason = errno;
  if (!fs::is_directory(folder, error)) {
    throw IoError(folder, std::string("cannot create: ") +
                              (reason == EEXIST ? "is a file, not a folder" : std::strerror(reason)));
  }
  take_rights_of_others(folder);
}

void begin_private_file(const fs::path& file) noexcept {
  if (!is_private(file.parent_path())) return;
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor >= 0) ::close(descriptor);
}

bool is_private(const fs::path& folder) {
  struct stat status {};
  return ::stat(folder.c_str(), &status) == 0 && (status.st_mode & kOfOthers) == 0;
}

void make_private(const fs::path& folder) noexcept {
  try {
    take_rights_of_others(folder);
    std::error_code error;
    auto entry =
        fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
      take_rights_of_others(entry->path());
  } catch (const std::exception&) {
    // Out of memory, or a folder that vanished meanwhile: the next opening tries again.
  }
}

}  // namespace arthronaut::files
