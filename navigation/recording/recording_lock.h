// Whether a session is being recorded now, by this program or another one of this machine: its recorder holds
// a lock of the kernel on the session's folder, which ends with it, also where it is killed. Who looks at
// such a session does not take it for one that was cut off.
#pragma once

#include <filesystem>

namespace arthronaut::recording {

class RecordingLock {
 public:
  // Where the kernel cannot lock folders (some network file systems) nothing is held.
  explicit RecordingLock(const std::filesystem::path& session_folder);
  ~RecordingLock();  // lets go
  RecordingLock(const RecordingLock&) = delete;
  RecordingLock& operator=(const RecordingLock&) = delete;

 private:
  int descriptor_;
};

// False where there is no such folder, or it cannot be told. Who reads whether the session was finished asks
// this before: one that ends in between is finished then.
[[nodiscard]] bool is_being_recorded(const std::filesystem::path& session_folder);

}  // namespace arthronaut::recording
