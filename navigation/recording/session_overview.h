// A session as far as it is whole, for whoever looks at it: everything but its frames, which
// session_timeline.h has, whatever the session's length. Who computes with a session reads it whole, by
// RecordedSession, which refuses what is broken.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "navigation/recording/session.h"

namespace arthronaut::recording {

struct SessionOverview {
  std::filesystem::path folder;
  SessionHeader header;
  pipeline::PipelineOptions options;
  bool was_finished = false;  // false: a crash cut it off, where its end could be read
  bool end_was_read = false;
  bool events_were_read = false;     // false: what was done after the last of them is not known
  bool is_being_recorded = false;    // when it was read (recording_lock.h)
  std::vector<SessionEvent> events;  // in the order they were added
  // Of a video by append_picture(), rising by frames; empty when the video is the source's own.
  std::vector<KeptPicture> pictures;
  strokes::Curves curves;
  std::optional<registration::RegistrationSummary> registration;
  // What is missing or broken, one sentence each with the file's name; empty when all is whole.
  std::vector<std::string> problems;

  [[nodiscard]] std::filesystem::path video() const;  // empty when none was kept
  // It was neither finished nor cut off.
  [[nodiscard]] bool goes_on() const { return is_being_recorded && !was_finished; }
  // Of a kPlanEvent. Throws InvalidInput.
  [[nodiscard]] RecordedSession::PlanChange plan_of(const SessionEvent& event) const;
};

// Whether a session must hold a registration.json: what a finished one has found last stands there.
[[nodiscard]] bool must_hold_registration(bool was_finished, const std::vector<SessionEvent>& events);

// Throws IoError or InvalidInput where nothing at all can be told: no folder, no session.json, or a newer
// one.
[[nodiscard]] SessionOverview read_overview(const std::filesystem::path& session_folder);

}  // namespace arthronaut::recording
