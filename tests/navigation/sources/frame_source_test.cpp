#include "navigation/sources/frame_source.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <chrono>

#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::sources {
namespace {

using test::message_of;
using test::TemporaryFolder;
using ::testing::HasSubstr;

// A pipe that nobody writes into would be waited for without end: as a video, as a picture and among the
// pictures of a pattern it is refused at once.
TEST(StalledSource, APipeIsRefusedAtOnce) {
  const TemporaryFolder folder;
  for (const char* name : {"scope.mkv", "f_1.png"}) ASSERT_EQ(::mkfifo((folder / name).c_str(), 0600), 0);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)open_video(folder / "scope.mkv"); }),
              HasSubstr("is a pipe"));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)open_video(folder / "f_1.png"); }),
              HasSubstr("is a pipe"));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)open_video(folder / "f_%d.png"); }), HasSubstr("no file"));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_picture(folder / "f_1.png"); }),
              HasSubstr("no file"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500));
}

// A device file and an address are no missing files: the message says what they are and what to give.
TEST(StalledSource, ADeviceFileAndAnAddressAreNamed) {
  EXPECT_THAT(message_of<InvalidInput>([] { (void)open_video("/dev/zero"); }),
              HasSubstr("is a device; give the number of a camera"));
  for (const char* address :
       {"rtsp://10.0.0.5/scope", "tcp://tower:5000", "udp://@:1234", "http://a/b.mkv"}) {
    EXPECT_THAT(message_of<InvalidInput>([&] { (void)open_video(address); }),
                HasSubstr("is a stream, and this needs a recording"))
        << address;
  }
  EXPECT_THAT(message_of<IoError>([] { (void)open_video("/nowhere/clip.mkv"); }), HasSubstr("no such file"));
}

// Phones and manuals begin an address with a capital.
TEST(StreamAddress, IsTheSameWhateverItsLettersAre) {
  EXPECT_EQ(with_small_scheme("Rtsp://Tower/Scope"), "rtsp://Tower/Scope");
  EXPECT_EQ(with_small_scheme("GST:videotestsrc ! appsink"), "gst:videotestsrc ! appsink");
  EXPECT_EQ(with_small_scheme("Clip.mkv"), "Clip.mkv");
  EXPECT_EQ(with_small_scheme("Gs"), "Gs");
  EXPECT_TRUE(is_stream_address("Gst:videotestsrc ! appsink"));
  EXPECT_EQ(kind_of_source("UDP://@:5000"), SourceKind::Live);
  const std::unique_ptr<FrameSource> opened =
      open_stream("GST:videotestsrc num-buffers=1 ! video/x-raw,format=BGR ! appsink");
  EXPECT_NE(opened->next(), nullptr);
}

TEST(StreamAddress, OfAKindThatNobodyKnowsIsToldWithoutOpening) {
  for (const char* address : {"rtsp://a/b", "RTSPS://a/b", "udp://@:1", "srt://a:1", "tcp://a:1", "rtp://@:1",
                              "http://a/b", "gst:videotestsrc ! appsink"})
    EXPECT_EQ(why_no_stream(address), "") << address;
  EXPECT_THAT(why_no_stream("rstp://a/b"), HasSubstr("rtsp://, rtsps://, udp://"));
}

}  // namespace
}  // namespace arthronaut::sources
