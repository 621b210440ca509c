// Any picture of a session's video, by its frame: for looking at it, forwards, backwards and across.
//
// What the recorder encoded without loss has nothing but key frames: a picture takes as long as decoding one.
// A copied video, and a stream that was kept as it came, take as long as decoding from the key frame before
// it; of a stream the last pictures are remembered, so that going back by one costs nothing. A still takes as
// long as reading it.
#pragma once

#include <cstdint>
#include <memory>

#include "navigation/recording/session_overview.h"

namespace arthronaut::recording {

// Threads: one at a time.
class RecordedPictures {
 public:
  // Throws IoError or InvalidInput; InvalidInput when no video was kept.
  explicit RecordedPictures(const SessionOverview& session);
  ~RecordedPictures();

  // Of the frame with this index and timestamp; null where none was kept or the video is broken there.
  // Throws IoError or InvalidInput for a still that cannot be read.
  [[nodiscard]] camera::FramePtr picture(std::int64_t frame_index, std::int64_t timestamp_ns);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::recording
