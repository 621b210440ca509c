#include "navigation/recording/recording_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

namespace arthronaut::recording {

namespace {

int open_folder(const std::filesystem::path& folder) {
  return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

}  // namespace

RecordingLock::RecordingLock(const std::filesystem::path& session_folder)
    : descriptor_(open_folder(session_folder)) {
  // It waits for whoever is just asking, who lets go at once.
  while (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

RecordingLock::~RecordingLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool is_being_recorded(const std::filesystem::path& session_folder) {
  const int descriptor = open_folder(session_folder);
  if (descriptor < 0) return false;
  const bool is_held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return is_held;
}

}  // namespace arthronaut::recording
