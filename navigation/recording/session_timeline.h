// The frames of a session for whoever looks at it: of every frame the few numbers that a time line draws, and
// everything of one frame when it is asked for. Two hours at 60 frames a second take 20 MB and are there in a
// second, where RecordedSession::frames() would take the best part of a gigabyte.
//
// A damaged record is read as far as it goes: problems() says what is missing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "navigation/recording/session.h"

namespace arthronaut::recording {

struct FrameGlance {
  std::int64_t index = 0, timestamp_ns = 0;
  // Of the guidance, where it was valid; NaN else.
  float offset_mm = std::numeric_limits<float>::quiet_NaN();
  float angle_deg = std::numeric_limits<float>::quiet_NaN();
  // Bit n: the nth of SessionTimeline::marker_ids() has a pose, or the body that it is the first marker of.
  std::uint32_t posed = 0;
  guidance::GuidanceState guidance = guidance::GuidanceState::NoPlan;
  bool intrinsics_are_known = false;

  [[nodiscard]] bool is_guided() const { return guidance == guidance::GuidanceState::Valid; }
};

// Threads: one at a time. The session's folder must stay where it is.
class SessionTimeline {
 public:
  // Throws IoError or InvalidInput where there is no record at all: no file, another program's, a newer
  // one's.
  explicit SessionTimeline(const std::filesystem::path& session_folder);
  ~SessionTimeline();
  SessionTimeline(SessionTimeline&&) noexcept;
  SessionTimeline& operator=(SessionTimeline&&) noexcept;

  [[nodiscard]] const std::vector<FrameGlance>& frames() const;  // in the order of their indices
  [[nodiscard]] const std::vector<int>& marker_ids() const;      // 32 at most
  [[nodiscard]] const std::vector<std::string>& problems() const;
  // Everything of frames()[at]; where the record is damaged there, what is known at a glance, and no
  // guidance. The last one is kept. Preconditions: at < frames().size().
  [[nodiscard]] const RecordedFrame& frame(std::size_t at) const;
  // Whether all of it could be read. Preconditions as above.
  [[nodiscard]] bool is_readable(std::size_t at) const;

  // Seconds from the first frame. Preconditions: at < frames().size().
  [[nodiscard]] double time_s(std::size_t at) const;
  // The frame that was shown at that time: the last one not after it. Preconditions: there are frames.
  [[nodiscard]] std::size_t at_time(double seconds) const;
  // The frame of that index, or the first one after it; the last one when there is none.
  [[nodiscard]] std::size_t at_index(std::int64_t frame_index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::recording
