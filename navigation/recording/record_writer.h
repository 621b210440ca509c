// Inner header: what a recorder hands to its writer's thread, and the one who carries it out: rows of the
// database, files, and the hashes of both.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "navigation/recording/frame_record.h"
#include "navigation/recording/open_formats.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_hashes.h"

namespace arthronaut::recording {

// Whatever a video's file gets again when it ends (its size, its length) lies in its first bytes.
inline constexpr std::int64_t kVideoHead = 65536;

struct PartBegun {
  std::string file;
};
struct PartEnded {
  std::string file;
};
// Files written by the same thread, so that a registration is on disk before the frame that used it.
struct RegistrationFile {
  std::string name;
  registration::RegistrationSummary registration;
  std::optional<registration::Provenance> of;
};
struct OtherFile {
  std::function<void()> write;
};
struct HeaderFile {
  SessionHeader header;
};
struct FrameLatency {
  std::int64_t frame = 0;
  SessionRecorder::Latency latency;
};
struct FrameDigests {
  std::int64_t frame = 0;
  SessionRecorder::StateDigests digests;
};
using Message =
    std::variant<pipeline::FrameResult, SessionEvent, KeptPicture, PartBegun, PartEnded, RegistrationFile,
                 OtherFile, strokes::Curves, FrameDigests, FrameLatency, HeaderFile>;

// One thread at a time. Members throw IoError.
class RecordWriter {
 public:
  RecordWriter(SessionDatabase& database, OpenFormats& formats, SessionHashes& hashes,
               std::filesystem::path folder, const pipeline::PipelineOptions& options);

  void write(const Message& message);
  // What was written is on the disk, and in the chain of hashes.
  void commit();
  // An event of the writer's own, after the last frame that was written.
  void write_event(std::string_view kind, std::string text);

 private:
  void put(const pipeline::FrameResult& result);
  void put(const SessionEvent& event);
  void put(const KeptPicture& picture);
  void put(const PartBegun& part);
  void put(const PartEnded& part);
  void put(const RegistrationFile& file);
  void put(const OtherFile& file) { file.write(); }
  void put(const HeaderFile& file);
  void put(const FrameDigests& frame);
  void put(const FrameLatency& frame);
  void put(const strokes::Curves& curves);

  SessionDatabase& database_;
  OpenFormats& formats_;
  SessionHashes& hashes_;
  std::filesystem::path folder_;
  const pipeline::PipelineOptions& options_;
  FrameInserter frames_;
  Statement event_, picture_, digests_, latency_;
  std::int64_t last_frame_ = -1, last_timestamp_ns_ = 0, picture_count_ = 0;
  std::vector<std::string> growing_;  // parts of the video that are being written
  bool in_transaction_ = false;
};

}  // namespace arthronaut::recording
