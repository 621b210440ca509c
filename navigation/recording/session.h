// A session on disk: what happened in theatre, so that a crash loses at most one second and everything can be run again.
//
//   session.json        format "arthronaut.session": bone, medium, tools, source, versions
//   session.sqlite      WAL; frames, poses, tips, guidance, events
//   video.mkv / .path   the video as it came; a file source is copied, or its path kept when copying was declined
//   poses.csv curves.csv registration.json guidance.csv     the same in open formats, written when the session ends
//   camera.json tools.json                                  what it was navigated with
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/pipeline/navigation_pipeline.h"
#include "navigation/strokes/curves.h"
#include "navigation/strokes/poses_file.h"

namespace arthronaut::recording {

struct SessionHeader {
  std::string id;          // the folder's name
  std::string started_utc; // ISO 8601
  bones::BoneKind bone = bones::BoneKind::Femur;
  bones::Side side = bones::Side::Right;
  double refractive_index = 1;
  std::string probe_name, guide_name;
  std::string source;      // name of the frame source
  std::string video;       // file name in the folder, or an absolute path; empty when no video was kept
  std::string program_version;
};

struct SessionEvent {
  std::int64_t timestamp_ns = 0;
  std::string kind;  // "stroke begin", "registration", "tunnel drilled", "note", ...
  std::string text;  // free text or JSON
};

// Writes while the operation goes on. append() never waits for the disk: it hands over to a writer thread by a bounded,
// lossless queue; the writer commits at least twice a second. Errors of the disk reach the next call as IoError.
class SessionRecorder {
 public:
  // The folder exists and is empty. Writes session.json, camera.json and tools.json at once.
  SessionRecorder(const std::filesystem::path& folder, const SessionHeader& header,
                  const pipeline::PipelineOptions& options);
  ~SessionRecorder();  // finish() unless it was called; errors are then lost
  void append(const pipeline::FrameResult& result);
  // The frame's picture, for sources that are not files (file sources are copied whole). Encoded losslessly enough to
  // track again (see the .cpp).
  void append_picture(const camera::FramePtr& frame);
  void add_event(const SessionEvent& event);
  void set_registration(const registration::RegistrationSummary& registration);
  void set_curves(const strokes::Curves& curves);
  // Commits, writes the open formats, closes. Throws IoError.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct RecordedFrame {
  std::int64_t index = 0, timestamp_ns = 0;
  lens::LensObservation lens;
  std::vector<strokes::PoseRow> poses;
  bool tip_is_valid = false;
  Eigen::Vector3d tip_in_world_mm = Eigen::Vector3d::Zero();
  guidance::GuidanceNumbers guidance;
};

// Reads a session, also one that a crash cut off. Throws IoError or InvalidInput.
class RecordedSession {
 public:
  explicit RecordedSession(const std::filesystem::path& folder);
  ~RecordedSession();
  [[nodiscard]] const SessionHeader& header() const;
  [[nodiscard]] bool was_finished() const;  // false: a crash cut it off
  [[nodiscard]] const std::vector<RecordedFrame>& frames() const;
  [[nodiscard]] const std::vector<SessionEvent>& events() const;
  [[nodiscard]] const strokes::Curves& curves() const;
  [[nodiscard]] const std::optional<registration::RegistrationSummary>& registration() const;
  [[nodiscard]] pipeline::PipelineOptions pipeline_options() const;  // to run it again
  [[nodiscard]] std::filesystem::path video() const;                 // empty when none was kept
  [[nodiscard]] std::filesystem::path folder() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::recording
