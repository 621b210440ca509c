// Whether a session is still what was recorded: its chain of hashes (chain.csv, see docs/conventions.md)
// followed from its first record to its last, and all that it speaks of hashed anew.
//
// It tells rot, a file that was cut off or exchanged, a number that was changed, a chain that was deleted or
// that lost what was written at the end of a session. What was added to a finished session and to its chain,
// and was taken out of both again, is not told. It does not tell somebody who makes the whole chain anew: who
// must know that keeps SessionCheck::head, which stands in the report, in another place.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace arthronaut::recording {

struct CheckFinding {
  std::string of;                 // "video.mkv", "session.sqlite:frames.2", "chain.csv"
  std::int64_t from = 0, to = 0;  // bytes, or numbers of rows, [from, to); both 0: as a whole
  // "not what was recorded", "missing", "not in the chain", ... Names files as they lie in the session.
  std::string what;

  // "video.mkv: bytes 1048576 to 2097151 are not what was recorded".
  [[nodiscard]] std::string text() const;
};

struct SessionCheck {
  enum class Outcome {
    NotRun,
    Unbroken,  // all that the chain speaks of is as it was
    Broken,    // see findings
    NoChain,   // and session.json does not say that there was one: nothing can be said
    Stopped,   // by `stops`; findings are what was found until then
  } outcome = Outcome::NotRun;
  bool is_being_recorded = false;  // when it was looked at (recording_lock.h)
  bool was_finished =
      false;  // false: cut off, or being recorded; what came after the chain's last record is not in it
  std::int64_t record_count = 0;
  std::int64_t covered_bytes = 0;  // of files
  std::string head;                // the chain's last hash
  std::vector<CheckFinding> findings;
  std::vector<std::string> notes;  // what could not be in it, one sentence each

  [[nodiscard]] bool is_unbroken() const { return outcome == Outcome::Unbroken; }
};

// Reads everything that was recorded once, some gigabytes in a few seconds. progress: records. Broken files
// are findings; throws IoError where there is no session.
[[nodiscard]] SessionCheck check_session(
    const std::filesystem::path& session_folder,
    const std::function<void(std::int64_t done, std::int64_t all)>& progress = {},
    const std::function<bool()>& stops = {});

// "unbroken: 1204 records, 512.0 MB", "broken: ...", for a line on the screen.
[[nodiscard]] std::string check_words(const SessionCheck& check);

// The last hash of a session's chain; empty where there is none, or it is broken.
[[nodiscard]] std::string chain_head(const std::filesystem::path& session_folder);

}  // namespace arthronaut::recording
