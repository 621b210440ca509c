// Any picture of a session's video, by its frame: for looking at it, forwards, backwards and across.
//
// What the recorder encoded without loss has nothing but key frames: a picture takes as long as decoding one.
// A copied video, and a stream that was kept as it came, take as long as decoding from the key frame before
// it, most of a second where hundreds of pictures lie between: what is passed on the way can be looked at
// meanwhile. The last pictures are remembered, so that going back by one costs nothing. A still takes as long
// as reading it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "navigation/recording/session_overview.h"
#include "navigation/sources/on_the_way.h"

namespace arthronaut::recording {

// Threads: one at a time.
class RecordedPictures {
 public:
  // Throws IoError or InvalidInput; InvalidInput when no video was kept. Precondition: not null.
  explicit RecordedPictures(std::shared_ptr<const SessionOverview> session);
  explicit RecordedPictures(SessionOverview session);
  ~RecordedPictures();

  // Of the frame with this index and timestamp; null where none was kept or the video is broken there.
  // Throws IoError or InvalidInput for a still that cannot be read.
  //
  // A picture that is passed says which one it is as the session knows it: by its index where the recorder
  // made the video, by its timestamp where the video is the source's own; the other one is -1. One that no
  // frame has is null.
  [[nodiscard]] camera::FramePtr picture(std::int64_t frame_index, std::int64_t timestamp_ns,
                                         const sources::OnTheWay& on_the_way = {});
  // For the time between two wishes of somebody who goes back: decodes what lies before the pictures
  // that are remembered, and remembers as many again. Begins where `goes_on` ended it the last time.
  void read_before_remembered(const std::function<bool()>& goes_on);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::recording
