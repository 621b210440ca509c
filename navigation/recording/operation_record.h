// The journal of an operation in a session, from its first frame, whether or not video is kept: commands,
// outcomes of the registration, frames, what guided and why not. A disk that fails ends the record, never the
// operation; a video that fails ends alone.
//
// Thread-free; the recorder behind it writes on a thread of its own and commits twice a second.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/operation/operation.h"
#include "navigation/recording/session.h"

namespace arthronaut::recording {

enum class KeepVideo {
  No,
  Copy,    // the source's file, as it is, when the record ends
  Refer,   // only where it is
  Encode,  // the source has no file: its pictures, from now on, as PicturesAs says
};

class OperationRecord {
 public:
  // The folder exists and is empty. `continues`: id of the session before it in this operation, or empty.
  // `pictures`: how the pictures of a source without a file are kept. Throws IoError.
  OperationRecord(const std::filesystem::path& folder, const operation::OperationSetup& setup,
                  const operation::SourceSetup& source, const sources::SourceInfo& info,
                  const std::string& continues, PicturesAs pictures = PicturesAs::AsTheyCame);

  // From the next frame on. `video` is the source's file or pattern (unused for Encode and No).
  void keep_video(KeepVideo keep, const std::filesystem::path& video = {});
  // What the operation has done since the last call; then the frame, its picture and what came of it.
  void add(const std::vector<operation::JournalEntry>& entries);
  void add_frame(const camera::FramePtr& picture, const operation::OperationState& state, bool is_live);
  // How long that frame had taken; and what is no decision of the operation's, but belongs into its record.
  void add_latency(const SessionRecorder::Latency& latency) { recorder_->append_latency(latency); }
  void add_event(std::string_view kind, const std::string& text, std::int64_t timestamp_ns) {
    recorder_->add_event({timestamp_ns, std::string(kind), text});
  }
  // See SessionRecorder.
  void never_wait() { recorder_->never_wait(); }
  [[nodiscard]] std::string video_trouble() const { return recorder_->video_trouble(); }
  // Throws IoError. The strokes are those that count.
  void finish(const strokes::Curves& strokes);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] KeepVideo keeps() const { return keep_; }

 private:
  std::filesystem::path folder_, copied_video_;
  KeepVideo keep_ = KeepVideo::No;
  std::unique_ptr<SessionRecorder> recorder_;
};

// How an entry stands among a session's events; nullopt for those that have a place of their own there.
[[nodiscard]] std::optional<SessionEvent> event_of(const operation::JournalEntry& entry);

// The same of an operation whose session is finished already: the surgeon decides after the source has ended,
// too. Throws IoError or InvalidInput; what came before is written then.
void append_entries(const std::filesystem::path& session_folder,
                    const std::vector<operation::JournalEntry>& entries);
// Writes a file of such a session anew by `write`, and what its record says of it. Throws IoError, and what
// `write` throws.
void rewrite_file(const std::filesystem::path& session_folder, const std::string& name,
                  const std::function<void()>& write);

}  // namespace arthronaut::recording
