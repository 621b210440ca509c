#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>

#include "navigation/recording/picture_writer.h"
#include "navigation/recording/session.h"
#include "planning/geometry/error.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

namespace fs = std::filesystem;

class RecordedVideo : public ::testing::Test {
 protected:
  const test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

// Smooth shading with an edge that moves: what an arthroscope shows, small.
camera::FramePtr moving_picture(std::int64_t index) {
  auto frame = std::make_shared<camera::Frame>(test::plain_frame(index, 0));
  for (int y = 0; y < frame->height; ++y) {
    for (int x = 0; x < frame->width; ++x) {
      const double shade = 90 + 60 * std::sin(x / 23.0) * std::cos(y / 17.0);
      const bool inside = std::abs(x - 40 - index) < 25 && std::abs(y - 50) < 25;
      std::uint8_t* pixel = &frame->bgr[static_cast<std::size_t>(3 * (y * frame->width + x))];
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(inside ? 30 : shade);
    }
  }
  return frame;
}

double rms_difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = static_cast<double>(a[i]) - b[i];
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

// Encoded pictures come back under their frames' indices and timestamps, also when a live source left some
// out, and with the colours they had to within the steps that colour is kept in: 2 grey values rms.
TEST_F(RecordedVideo, GivesPicturesBackUnderTheirFrames) {
  {
    recording::SessionRecorder recorder(folder_, test::session_header(), test::scripted_options());
    for (int i = 0; i < 30; ++i) {
      if (i % 5 != 3) recorder.append_picture(moving_picture(i));
      recorder.append(test::frame_result(i));
    }
    recorder.finish();
  }
  const recording::RecordedSession session(folder_);
  EXPECT_TRUE(session.header().video_is_reencoded);
  const auto video = recording::open_recorded_video(session);
  for (int i = 0; i < 30; ++i) {
    if (i % 5 == 3) continue;
    const camera::FramePtr frame = video->next();
    ASSERT_NE(frame, nullptr) << i;
    EXPECT_EQ(frame->index, i);
    EXPECT_EQ(frame->timestamp_ns, test::frame_result(i).timestamp_ns);
    EXPECT_LT(rms_difference(frame->bgr, moving_picture(i)->bgr), 2.0) << i;
  }
  EXPECT_EQ(video->next(), nullptr);
}

// A killed recording's video is readable up to the last second, in spite of its missing end.
TEST_F(RecordedVideo, IsReadableAfterAKill) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    recording::SessionRecorder recorder(folder_, test::session_header(), test::scripted_options());
    for (int i = 0; i < 150; ++i) {
      recorder.append_picture(moving_picture(i % 60));
      recorder.append(test::frame_result(i));
      ::usleep(10000);
    }
    ::kill(::getpid(), SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
  const recording::RecordedSession session(folder_);
  EXPECT_FALSE(session.was_finished());
  const auto video = recording::open_recorded_video(session);
  int count = 0;
  while (video->next()) ++count;
  EXPECT_GE(count, 90);
}

// Pictures of another size and folders that are not there are errors, not crashes.
TEST_F(RecordedVideo, ReportsWhatTheEncoderCannotDo) {
  recording::PictureWriter resized(folder_, {});
  resized.write(moving_picture(0));
  auto small = std::make_shared<camera::Frame>(*moving_picture(1));
  small->height /= 2;
  small->bgr.resize(small->bgr.size() / 2);
  resized.write(small);
  EXPECT_THROW(resized.finish(), InvalidInput);

  recording::PictureWriter nowhere(folder_ / "missing", {});
  nowhere.write(moving_picture(0));
  EXPECT_THROW(nowhere.finish(), IoError);
}

}  // namespace
}  // namespace arthronaut
