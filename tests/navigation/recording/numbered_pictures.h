// Pictures of which can be read off which one they are, and videos made of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <random>
#include <string>
#include <vector>

#include "navigation/recording/session.h"
#include "tests/navigation/recording/recorded_frames.h"

namespace arthronaut::recording {

inline constexpr int kFrames = 240;

// The number in bright and dark fields, and nothing else: which picture it is can be read off it.
inline constexpr int kWidth = 320, kHeight = 96;
inline cv::Mat numbered(int number) {
  cv::Mat picture(kHeight, kWidth, CV_8UC3, cv::Scalar(40, 40, 40));
  for (int bit = 0; bit < 8; ++bit)
    if ((number >> bit & 1) != 0)
      cv::rectangle(picture, cv::Rect(8 + 36 * bit, 16, 32, 64), cv::Scalar(220, 220, 220), cv::FILLED);
  return picture;
}
inline int number_of(const camera::Frame& frame) {
  int number = 0;
  for (int bit = 0; bit < 8; ++bit) {
    const std::size_t at =
        3 * (static_cast<std::size_t>(48) * kWidth + static_cast<std::size_t>(24 + 36 * bit));
    if (frame.bgr[at] > 128) number |= 1 << bit;
  }
  return number;
}
inline camera::FramePtr frame_of(int number) {
  const cv::Mat picture = numbered(number);
  auto frame = std::make_shared<camera::Frame>();
  frame->index = number;
  frame->width = kWidth;
  frame->height = kHeight;
  frame->bgr.assign(picture.datastart, picture.dataend);
  return frame;
}

// Asks for the frames in a seeded order, forwards, backwards and across.
inline std::vector<int> seeded_order(int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<int> order;
  for (int i = 0; i < 80; ++i) order.push_back(std::uniform_int_distribution(0, count - 1)(random));
  for (int i = 0; i < std::min(count, 10); ++i) order.push_back(i);
  for (int i = count - 1; i > std::max(count - 10, 0); --i) order.push_back(i);
  order.push_back(0);
  return order;
}

// A session with a copy of a video that another program made, of the pictures 0, 1, ...
inline void copy_numbered_video(const std::filesystem::path& file, const std::string& code,
                                const std::filesystem::path& session) {
  {
    cv::VideoWriter writer(file.string(), cv::VideoWriter::fourcc(code[0], code[1], code[2], code[3]), 60,
                           {kWidth, kHeight});
    ASSERT_TRUE(writer.isOpened());
    for (int i = 0; i < kFrames; ++i) writer.write(numbered(i));
  }
  std::filesystem::create_directory(session);
  SessionRecorder recorder(session, test::session_header(), test::scripted_options());
  for (int i = 0; i < kFrames; ++i) recorder.append(test::frame_result(i));
  recorder.copy_video(file);
  recorder.finish();
}

}  // namespace arthronaut::recording
