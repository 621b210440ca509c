// Live frames into a session, and what is told of each picture that was given to its recorder.
#pragma once

#include <cstdint>
#include <vector>

#include "navigation/recording/session.h"
#include "tests/navigation/recording/recorded_frames.h"

namespace arthronaut::test {

struct GivenPicture {
  std::int64_t frame = 0;
  std::uint64_t luma = 0;
};

inline std::uint64_t luma_of_picture(const camera::Frame& frame) {
  std::vector<std::uint8_t> gray;
  return recording::digest_of_luma(camera::luma_of(frame, gray));
}

// As they came, until `stops` says so.
template <typename Stops>
void record(sources::FrameSource& source, recording::SessionRecorder& recorder, const Stops& stops) {
  recorder.keep_pictures(recording::PicturesAs::AsTheyCame, source.info());
  while (const camera::FramePtr frame = source.next()) {
    recorder.append(frame_result(frame->index));
    if (frame->index % 11 != 4) recorder.append_picture(frame);
    if (stops(GivenPicture{frame->index, luma_of_picture(*frame)})) return;
  }
}

}  // namespace arthronaut::test
