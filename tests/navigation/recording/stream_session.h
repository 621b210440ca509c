// A stream that is kept as it came, in sessions of the tests.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/navigation/recording/streams.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {

// A sender of H.264 with key frames a second and a half apart.
class StreamSession : public ::testing::Test {
 protected:
  StreamSession() {
    test::make_clip(clips_ / "clip.mkv", 900,
                    {"-c:v", "libx264", "-preset", "ultrafast", "-tune", "zerolatency", "-g", "45"});
    sender_ = test::send_by_rtsp(port_, test::h264_clip_launch(clips_ / "clip.mkv"));
  }
  [[nodiscard]] std::unique_ptr<sources::FrameSource> open() const {
    return test::open_when_there(test::rtsp_address(port_));
  }

  const test::TemporaryFolder clips_;
  const std::string port_ = test::stream_port(0);
  std::unique_ptr<test::ChildProcess> sender_;
};

}  // namespace arthronaut::recording
