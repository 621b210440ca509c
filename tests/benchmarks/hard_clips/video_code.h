// What a recorder does to pictures: H.264 in memory, frame by frame.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

namespace arthronaut::hard_clips {

class VideoCode {
 public:
  // Throws InvalidInput when this libavcodec has no H.264 encoder.
  VideoCode(int width, int height, double frames_per_second, double bit_rate);
  ~VideoCode();
  VideoCode(const VideoCode&) = delete;
  VideoCode& operator=(const VideoCode&) = delete;
  // CV_8UC3 in, CV_8UC3 of the same frame as it would be seen after decoding.
  void code(cv::Mat& bgr);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::hard_clips
