// Inner header: what is still written to a session that is finished, as the surgeon decides after the source
// has ended, too.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "navigation/recording/session.h"
#include "navigation/recording/session_hashes.h"

namespace arthronaut::recording {

// Reads the session's chain of hashes once, when it is made: two hours of it are megabytes. One at a time for
// a session. A session without a chain, or with a broken one, is written to without it. Members throw
// IoError; what was written before stays.
class FinishedSession {
 public:
  explicit FinishedSession(const std::filesystem::path& session_folder);
  void append_event(const SessionEvent& event);
  // After the last event.
  void close_database();
  // Writes a file anew by `write`, and what the record says of it. Throws what `write` throws, too.
  void rewrite_file(const std::string& name, const std::function<void()>& write);

 private:
  std::filesystem::path folder_;
  std::optional<SessionHashes> hashes_;
};

}  // namespace arthronaut::recording
