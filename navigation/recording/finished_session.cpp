#include "navigation/recording/finished_session.h"

#include <algorithm>

#include "navigation/recording/operation_record.h"
#include "navigation/recording/session_database.h"
#include "navigation/recording/session_files.h"

namespace arthronaut::recording {

FinishedSession::FinishedSession(const std::filesystem::path& session_folder)
    : folder_(session_folder), hashes_(SessionHashes::of_finished(session_folder)) {}

void FinishedSession::append_event(const SessionEvent& event) {
  if (hashes_) hashes_->announce_events();
  SessionDatabase database = SessionDatabase::open(database_file(folder_));
  Statement last = database.prepare("SELECT MAX(frame), MAX(timestamp_ns) FROM frames");
  const bool has_frames = last.step() && !last.is_null(0);
  const std::int64_t after = has_frames ? last.integer(0) : -1;
  // Who has no pictures of it any more has no time of theirs, either.
  const std::int64_t time_ns =
      has_frames ? std::max(event.timestamp_ns, last.integer(1)) : event.timestamp_ns;
  Statement insert =
      database.prepare("INSERT INTO events(after_frame, timestamp_ns, kind, text) VALUES(?,?,?,?)");
  insert.bind(1, after).bind(2, time_ns).bind(3, event.kind).bind(4, event.text).run();
  if (!hashes_) return;
  hashes_->cover_rows(database, kEventRows, rows_end(database, kEventRows));
  hashes_->sync();
}

void FinishedSession::close_database() {
  // One that somebody still reads is sealed, and hashed, another time.
  if (hashes_ && SessionDatabase::open(database_file(folder_)).is_sealed()) hashes_->cover_sealed_database();
}

void FinishedSession::rewrite_file(const std::string& name, const std::function<void()>& write) {
  if (!hashes_) return write();
  hashes_->write_file(name, write);
  hashes_->sync();
}

void append_event(const std::filesystem::path& session_folder, const SessionEvent& event) {
  FinishedSession session(session_folder);
  session.append_event(event);
  session.close_database();
}

void rewrite_file(const std::filesystem::path& session_folder, const std::string& name,
                  const std::function<void()>& write) {
  FinishedSession(session_folder).rewrite_file(name, write);
}

}  // namespace arthronaut::recording
