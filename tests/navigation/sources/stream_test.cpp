// Streams as they come: sent over the loopback by other programs, which are killed and started again.
#include <gmock/gmock.h>
#include <gst/rtsp-server/rtsp-server.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "navigation/sources/capture_time.h"
#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "tests/child_process.h"
#include "tests/message_of.h"
#include "tests/navigation/recording/streams.h"

namespace arthronaut::sources {
namespace {

using test::message_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr double kRate = 30;
constexpr double kInterval_s = 1 / kRate;

// A port of this process alone, so that tests side by side do not hear each other.
std::string port(int offset) { return std::to_string(20000 + (::getpid() * 4 + offset) % 40000); }

// As one sees a sender that began long before its next key frame.
enum class KeyFrames { Sent, LeftOut };

// ffmpeg sending a test picture as MPEG-TS, at its own rate, until it is killed.
class Sender {
 public:
  Sender(const std::string& address, const std::string& size, KeyFrames key_frames = KeyFrames::Sent)
      : process_(test::run_ffmpeg({"-re", "-f", "lavfi", "-i", "testsrc=size=" + size + ":rate=30", "-c:v",
                                   "libx264", "-tune", "zerolatency", "-g", "10", "-bf", "0", "-bsf:v",
                                   key_frames == KeyFrames::Sent ? "null" : "noise=drop=key", "-f", "mpegts",
                                   address + "?pkt_size=1316"})) {}

 private:
  test::ChildProcess process_;
};

double age_s(const camera::Frame& frame) {
  return static_cast<double>(steady_now_ns() - frame.captured_ns) * 1e-9;
}

double median_interval_s(const std::vector<camera::FramePtr>& frames) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < frames.size(); ++i)
    intervals.push_back(static_cast<double>(frames[i]->timestamp_ns - frames[i - 1]->timestamp_ns) * 1e-9);
  return geometry::median(std::move(intervals), 0);
}

std::vector<camera::FramePtr> take(FrameSource& source, int count) {
  std::vector<camera::FramePtr> frames;
  for (int i = 0; i < count; ++i) frames.push_back(source.next());
  return frames;
}

void expect_live(FrameSource& source, camera::CaptureClock clock) {
  EXPECT_TRUE(source.info().is_live());
  EXPECT_EQ(source.info().image_size_px, Eigen::Vector2i(320, 240));
  const auto frames = take(source, 60);
  // A sender that keeps its rate: its own stamps say so to the 90 kHz of the stream, whatever the arrivals
  // did.
  EXPECT_NEAR(median_interval_s(frames), kInterval_s, 0.002);
  EXPECT_EQ(frames.back()->index, 59);
  EXPECT_EQ(frames.back()->capture_clock, clock);
  std::vector<std::uint8_t> gray, bgr;
  EXPECT_EQ(camera::luma_of(*frames.back(), gray).height, 240);
  EXPECT_TRUE(gray.empty()) << "no luma is made of colours";
  EXPECT_EQ(camera::bgr_of(*frames.back(), bgr).size(), 320U * 240U * 3U);
  // Each stage knows when it was done.
  EXPECT_LE(frames.back()->captured_ns, frames.back()->received_ns);
  EXPECT_LE(frames.back()->received_ns, frames.back()->decoded_ns);
  // Taken as it came: no queue that grows. The rest is what a busy machine takes.
  EXPECT_GE(age_s(*frames.back()), 0);
  EXPECT_LT(age_s(*frames.back()), 1);
}

// At most 20 s.
template <typename Condition>
bool waits_for(const Condition& condition) {
  for (int i = 0; i < 2000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

TEST(Stream, IsReadFromAUdpPort) {
  const std::string address = "udp://127.0.0.1:" + port(0);
  const Sender sender(address, "320x240");
  const auto source = open_source(address);
  expect_live(*source, camera::CaptureClock::Network);
}

// A picture of more bytes than libavformat gives at once, as key frames of a large picture are, comes whole:
// cut in two, every one of these would be damaged, and those that rest on it green below.
TEST(Stream, ALargePictureComesWholeFromAUdpPort) {
  const std::string address = "udp://127.0.0.1:" + port(3);
  const test::ChildProcess sender(
      test::run_ffmpeg({"-re", "-f", "lavfi", "-i", "color=gray:size=640x480:rate=10,noise=alls=80:allf=t",
                        "-c:v", "libx264", "-preset", "ultrafast", "-tune", "zerolatency", "-qp", "24", "-g",
                        "1", "-f", "mpegts", address + "?pkt_size=1316"}));
  const auto source = open_source(address);
  const auto frames = take(*source, 20);
  ASSERT_NE(source->info().packets, nullptr);
  EXPECT_NEAR(median_interval_s(frames), 0.1, 0.01);
  const camera::Frame& last = *frames.back();
  EXPECT_LT(last.timestamp_ns - frames.front()->timestamp_ns, 3'000'000'000) << "none is left out";
  std::vector<std::uint8_t> scratch;
  const std::vector<std::uint8_t>& bgr = camera::bgr_of(last, scratch);
  double green = 0, red = 0;
  const std::size_t lowest = bgr.size() - static_cast<std::size_t>(3 * last.width) * 100;
  for (std::size_t i = lowest; i < bgr.size(); i += 3) {
    green += bgr[i + 1];
    red += bgr[i + 2];
  }
  EXPECT_NEAR(green / red, 1, 0.1);
}

// Pulled out and plugged in again: pictures go on, their numbers and times too.
TEST(Stream, IsTakenUpAgain) {
  const std::string address = "udp://127.0.0.1:" + port(1);
  auto sender = std::make_unique<Sender>(address, "320x240");
  const auto source = open_source(address);
  const auto before = take(*source, 10);
  sender.reset();
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    sender = std::make_unique<Sender>(address, "320x240");
  });
  // What was sent before is still on its way; then the gap shows in the times.
  camera::FramePtr last = before.back(), next = source->next();
  while (next->timestamp_ns - last->timestamp_ns < 1'000'000'000 && next->index < 200)
    last = std::exchange(next, source->next());
  later.join();
  EXPECT_EQ(next->index, last->index + 1);
  EXPECT_GT(next->timestamp_ns - last->timestamp_ns, 1'000'000'000);
  EXPECT_LT(age_s(*next), 1);
}

// Another camera at the end of the cable is not what was calibrated: it is said, nothing is given, and when
// the right one is back it goes on.
TEST(Stream, AnotherSizeIsToldAndPassedOver) {
  const std::string address = "udp://127.0.0.1:" + port(2);
  auto sender = std::make_unique<Sender>(address, "320x240");
  const auto source = open_source(address);
  (void)take(*source, 10);
  const std::shared_ptr<SourceLine> line = source->info().line;
  ASSERT_NE(line, nullptr);
  std::atomic<int> wrong_size = 0;
  std::thread reader([&] {
    while (const camera::FramePtr frame = source->next()) wrong_size += frame->width != 320 ? 1 : 0;
  });
  sender.reset();
  sender = std::make_unique<Sender>(address, "640x480");
  EXPECT_TRUE(waits_for([&] { return line->trouble().find("changed to 640 x 480") != std::string::npos; }))
      << line->trouble();
  EXPECT_EQ(line->changed_to_px(), Eigen::Vector2i(640, 480));
  sender.reset();
  sender = std::make_unique<Sender>(address, "320x240");
  EXPECT_TRUE(waits_for([&] { return line->trouble().empty(); })) << line->trouble();
  EXPECT_FALSE(line->changed_to_px());
  line->end();
  reader.join();
  EXPECT_EQ(wrong_size, 0);
}

// Packets that make no picture hold nobody up: it is told what is missing, a reader can be ended, and the
// first key frame goes on where pictures left off.
TEST(Stream, WithoutAKeyFrameIsToldAndTakenUpWithTheNext) {
  const std::string address = "udp://127.0.0.1:" + port(1);
  auto sender = std::make_unique<Sender>(address, "320x240");
  const auto source = open_source(address);
  (void)take(*source, 10);
  const std::shared_ptr<SourceLine> line = source->info().line;
  std::atomic<int> count = 0;
  std::thread reader([&] {
    while (source->next()) ++count;
  });
  sender.reset();
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));  // broken off: a decoder begins anew
  sender = std::make_unique<Sender>(address, "320x240", KeyFrames::LeftOut);
  EXPECT_TRUE(waits_for([&] { return line->trouble().find("without a key frame") != std::string::npos; }))
      << line->trouble();
  const int before = count;
  sender = nullptr;
  sender = std::make_unique<Sender>(address, "320x240");
  EXPECT_TRUE(waits_for([&] { return count > before && line->trouble().empty(); })) << line->trouble();
  sender = nullptr;
  sender = std::make_unique<Sender>(address, "320x240", KeyFrames::LeftOut);
  std::this_thread::sleep_for(std::chrono::seconds(2));
  line->end();
  reader.join();  // within the time of the test
}

// Whoever names such a stream is told after the 10 s that a picture may take.
TEST(Stream, WithoutAKeyFrameIsNotOpenedForever) {
  const std::string address = "udp://127.0.0.1:" + port(2);
  const Sender sender(address, "320x240", KeyFrames::LeftOut);
  EXPECT_THAT(message_of<DeviceError>([&] { (void)open_source(address); }), HasSubstr("without a key frame"));
}

TEST(Stream, AnAddressIsShownWithoutItsPassword) {
  EXPECT_EQ(shown_address("rtsp://user:secret@tower:554/scope@2"), "rtsp://tower:554/scope@2");
  EXPECT_EQ(shown_address("rtsp://user@tower"), "rtsp://tower");
  EXPECT_EQ(shown_address("rtsp://user:sec/ret@tower/scope"), "rtsp://tower/scope");
  EXPECT_EQ(shown_address("rtsp://user:se@cret@tower/scope"), "rtsp://tower/scope");
  for (const char* password : {"12/ss", "12?x", "554/a@b"})
    EXPECT_EQ(shown_address("rtsp://user:" + std::string(password) + "@tower/scope"), "rtsp://tower/scope");
  EXPECT_EQ(shown_address("gst:rtspsrc location=\"rtsp://user:secret@tower/a\" user-pw=secret ! appsink"),
            "gst:rtspsrc location=\"rtsp://tower/a\" user-pw=*** ! appsink");
  EXPECT_EQ(shown_address("srt://tower:9000?passphrase=secret&mode=caller"),
            "srt://tower:9000?passphrase=***&mode=caller");
  for (const char* plain : {"rtsp://tower/scope", "udp://@:5000", "gst:a@b ! appsink", "rtsp://tower/a@b"})
    EXPECT_EQ(shown_address(plain), plain);
  EXPECT_THAT(message_of<InvalidInput>(
                  [] { (void)open_source("gst:rtspsrc location=rtsp://user:secret@tower/a ! fakesink"); }),
              AllOf(HasSubstr("rtsp://tower/a"), Not(HasSubstr("secret"))));
  EXPECT_THAT(message_of<DeviceError>([] { (void)open_source("rtsp://user:secret@127.0.0.1:1/scope"); }),
              AllOf(HasSubstr("rtsp://127.0.0.1:1/scope: "), Not(HasSubstr("secret"))));
}

TEST(Stream, NobodyThereIsSaidAtOnce) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(message_of<DeviceError>([] { (void)open_source("rtsp://127.0.0.1:1/scope"); }),
              HasSubstr("rtsp://127.0.0.1:1/scope: the machine is there, but nothing answers at this port"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

// A server of GStreamer's in this process.
class RtspServer {
 public:
  explicit RtspServer(const std::string& at_port) {
    gst_init(nullptr, nullptr);
    server_ = gst_rtsp_server_new();
    gst_rtsp_server_set_service(server_, at_port.c_str());
    GstRTSPMediaFactory* const factory = gst_rtsp_media_factory_new();
    gst_rtsp_media_factory_set_launch(
        factory,
        "( videotestsrc is-live=true ! video/x-raw,format=I420,width=320,height=240,framerate=30/1 ! jpegenc "
        "! "
        "rtpjpegpay name=pay0 )");
    GstRTSPMountPoints* const mounts = gst_rtsp_server_get_mount_points(server_);
    gst_rtsp_mount_points_add_factory(mounts, "/scope", factory);
    g_object_unref(mounts);
    gst_rtsp_server_attach(server_, nullptr);
    loop_ = g_main_loop_new(nullptr, FALSE);
    thread_ = std::thread([this] { g_main_loop_run(loop_); });
  }
  ~RtspServer() {
    g_main_loop_quit(loop_);
    thread_.join();
    g_main_loop_unref(loop_);
    g_object_unref(server_);
  }
  RtspServer(const RtspServer&) = delete;
  RtspServer& operator=(const RtspServer&) = delete;

 private:
  GstRTSPServer* server_;
  GMainLoop* loop_;
  std::thread thread_;
};

TEST(Stream, IsReadFromAnRtspServer) {
  const RtspServer server(port(3));
  const auto source = open_source("rtsp://127.0.0.1:" + port(3) + "/scope");
  expect_live(*source, camera::CaptureClock::Network);
  // A name that it has not, in words that tell what to look after.
  EXPECT_THAT(message_of<DeviceError>([] { (void)open_source("rtsp://127.0.0.1:" + port(3) + "/other"); }),
              HasSubstr("/other: the server has no stream of that name"));
}

TEST(GStreamerPipeline, GivesItsPicturesAndStamps) {
  const auto source = open_source(
      "gst:videotestsrc is-live=true ! video/x-raw,width=320,height=240,framerate=30/1 ! appsink");
  expect_live(*source, camera::CaptureClock::Driver);
}

// Whatever waits in a pipeline is as old as it is when it comes out of it.
TEST(GStreamerPipeline, Hazard3WhatWaitedForSecondsIsOld) {
  const auto source = open_source(
      "gst:videotestsrc is-live=true ! video/x-raw,width=64,height=48,framerate=30/1 ! "
      "queue min-threshold-time=2500000000 max-size-time=0 max-size-buffers=0 max-size-bytes=0 ! appsink");
  const camera::FramePtr picture = source->next();
  ASSERT_NE(picture, nullptr);
  EXPECT_EQ(picture->capture_clock, camera::CaptureClock::Driver);
  EXPECT_GE(static_cast<double>(picture->received_ns - picture->captured_ns) * 1e-9, 2.4);
}

// Grey is grey in every format on the way: 601's luma of a plain picture, to a step of rounding.
TEST(GStreamerPipeline, EveryFormatHasTheSameLuma) {
  for (const char* format : {"I420", "NV12", "P010_10LE", "BGR", "GRAY8", "YUY2", "UYVY", "RGBA", "Y42B"}) {
    const auto source = open_source(
        "gst:videotestsrc num-buffers=2 pattern=solid-color foreground-color=0xff808080 ! "
        "video/x-raw,width=64,height=48,format=" +
        std::string(format) + " ! appsink");
    std::vector<std::uint8_t> gray;
    camera::gray_from(*source->next(), gray);
    EXPECT_NEAR(gray[64 * 24 + 32], 128, 2) << format;
  }
}

// Whoever shows a picture gets its colours, whatever it came as.
TEST(GStreamerPipeline, ColoursAreMadeWhenTheyAreAskedFor) {
  for (const char* format : {"I420", "NV12", "P010_10LE", "BGR", "YUY2", "UYVY"}) {
    const auto source = open_source(
        "gst:videotestsrc num-buffers=2 pattern=solid-color foreground-color=0xff3060c0 ! "
        "video/x-raw,width=64,height=48,colorimetry=bt601,format=" +
        std::string(format) + " ! appsink");
    const camera::FramePtr frame = source->next();
    std::vector<std::uint8_t> made;
    const std::vector<std::uint8_t>& bgr = camera::bgr_of(*frame, made);
    ASSERT_EQ(bgr.size(), 64U * 48U * 3U) << format;
    const std::size_t middle = 3 * (64 * 24 + 32);
    EXPECT_NEAR(bgr[middle], 0xc0, 4) << format;
    EXPECT_NEAR(bgr[middle + 1], 0x60, 4) << format;
    EXPECT_NEAR(bgr[middle + 2], 0x30, 4) << format;
  }
}

TEST(GStreamerPipeline, EndsWhenItEnds) {
  const auto source =
      open_source("gst:videotestsrc num-buffers=3 ! video/x-raw,width=64,height=48 ! appsink");
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(source->next());
  EXPECT_FALSE(source->next());
}

TEST(GStreamerPipeline, WhatIsNoneIsRefusedWithTheReason) {
  EXPECT_THAT(message_of<InvalidInput>([] { (void)open_source("gst:nosuchthing ! appsink"); }),
              HasSubstr("nosuchthing"));
  EXPECT_THAT(message_of<InvalidInput>([] { (void)open_source("gst:videotestsrc ! fakesink"); }),
              HasSubstr("must end in an appsink"));
  EXPECT_THAT(
      message_of<DeviceError>([] { (void)open_source("gst:filesrc location=/nowhere/clip ! appsink"); }),
      HasSubstr("/nowhere/clip"));
}

TEST(SourceName, SaysWhatIsLive) {
  for (const char* live :
       {"/dev/video0", "/dev/video12", "rtsp://a/b", "udp://@:1234", "gst:videotestsrc ! appsink"})
    EXPECT_EQ(kind_of_source(live), SourceKind::Live) << live;
  for (const char* recording :
       {"/dev/video", "/dev/videox", "clip.mkv", "f_%04d.png", "C:/clip.mkv", "/dev/video0/x"})
    EXPECT_EQ(kind_of_source(recording), SourceKind::Recording) << recording;
}

}  // namespace
}  // namespace arthronaut::sources
