// Streams kept as they came: what was seen of them, live, comes back to the last bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <future>
#include <map>
#include <random>
#include <thread>
#include <utility>

#include "navigation/recording/picture_writer.h"
#include "navigation/sources/kept_stream.h"
#include "planning/geometry/error.h"
#include "tests/navigation/recording/streams.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {
namespace {

using test::make_clip;
using test::open_when_there;
using test::rtsp_address;
using test::send_by_rtsp;
using test::send_by_udp;
using test::stream_port;

struct SeenPicture {
  std::int64_t index = 0, packet = 0;
  std::uint64_t luma = 0;
};

// Takes pictures of a source, keeps them, and reads them back.
class StreamCopyTest : public ::testing::Test {
 protected:
  void begin(const std::shared_ptr<const sources::EncodedPackets>& packets,
             PicturesAs as = PicturesAs::AsTheyCame) {
    PictureNews news;
    news.begun = [this](const VideoPart& part, const camera::Frame&, const std::string& why) {
      parts_.push_back(part);
      reasons_.push_back(why);
    };
    news.kept = [this](const KeptPicture& kept) { kept_.push_back(kept); };
    news.ended = [this](const VideoPart&) { ++ended_; };
    writer_.emplace(folder_.path(), PictureWriterOptions{as, packets, 30}, news);
  }

  void keep(const camera::FramePtr& frame) {
    std::vector<std::uint8_t> gray;
    seen_.push_back({frame->index, frame->packet, digest_of_luma(camera::luma_of(*frame, gray))});
    writer_->write(frame);
  }
  // Every seventh is left out, as a busy machine does.
  void keep_of(sources::FrameSource& source, int count) {
    for (int i = 0; i < count; ++i) {
      const camera::FramePtr frame = source.next();
      ASSERT_NE(frame, nullptr);
      if (frame->index % 7 != 3) keep(frame);
    }
  }

  // Every picture that was seen is there, under its frame, to the last bit: as a replay reads them, and as
  // they are looked at, in a seeded order.
  void expect_all_seen_again() {
    writer_->finish();
    ASSERT_EQ(kept_.size(), seen_.size());
    ASSERT_EQ(static_cast<std::size_t>(ended_), parts_.size());
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      const std::size_t end =
          part + 1 < parts_.size() ? static_cast<std::size_t>(parts_[part + 1].first_picture) : kept_.size();
      SCOPED_TRACE(parts_[part].file);
      expect_part_seen_again(parts_[part], static_cast<std::size_t>(parts_[part].first_picture), end);
    }
  }

  const test::TemporaryFolder folder_;
  std::optional<PictureWriter> writer_;
  std::vector<SeenPicture> seen_;
  std::vector<VideoPart> parts_;
  std::vector<std::string> reasons_;
  std::vector<KeptPicture> kept_;
  int ended_ = 0;

 private:
  void expect_part_seen_again(const VideoPart& part, std::size_t begin, std::size_t end) {
    const std::filesystem::path file = folder_ / part.file;
    std::map<std::int64_t, std::uint64_t> replayed;
    std::vector<std::uint8_t> gray;
    sources::KeptStreamFile stream{file, part.held_back, {}};
    if (part.as == PicturesAs::AsTheyCame) {
      sources::KeptStream video(stream, sources::KeptStream::Use::ToReplay);
      while (const camera::FramePtr frame = video.next())
        replayed[frame->packet] = digest_of_luma(camera::luma_of(*frame, gray));
    } else {
      const auto video = sources::open_video_with_exact_luma(file);
      while (const camera::FramePtr frame = video->next())
        replayed[frame->index] = digest_of_luma(camera::luma_of(*frame, gray));
    }
    for (std::size_t i = begin; i < end; ++i) {
      EXPECT_EQ(kept_[i].frame, seen_[i].index);
      ASSERT_TRUE(replayed.contains(kept_[i].packet)) << i;
      EXPECT_EQ(replayed[kept_[i].packet], seen_[i].luma) << i;
      EXPECT_EQ(kept_[i].luma, seen_[i].luma);
      if (stream.starts.empty() || stream.starts.back().packet < kept_[i].start_packet)
        stream.starts.push_back({kept_[i].start_packet, kept_[i].start_ms});
    }
    if (part.as != PicturesAs::AsTheyCame) return;
    sources::KeptStream looked_at(stream, sources::KeptStream::Use::ToLookAt);
    std::mt19937 random(5);
    for (int i = 0; i < 40; ++i) {
      const std::size_t at = std::uniform_int_distribution(begin, end - 1)(random);
      const camera::FramePtr frame = looked_at.picture(kept_[at].packet);
      ASSERT_NE(frame, nullptr) << at;
      EXPECT_EQ(digest_of_luma(camera::luma_of(*frame, gray)), seen_[at].luma) << at;
    }
  }
};

// Codecs as encoders of live pictures use them, and as they should not: pictures in two orders, several
// slices, parameter sets again with every key frame, key frames far apart.
TEST_F(StreamCopyTest, EveryCodecComesBackToTheLastBit) {
  const std::map<std::string, std::vector<std::string>> codecs = {
      {"h264", {"-c:v", "libx264", "-preset", "ultrafast", "-tune", "zerolatency", "-g", "20"}},
      {"h264 with B-frames", {"-c:v", "libx264", "-preset", "veryfast", "-bf", "3", "-g", "24"}},
      {"h264, full range",
       {"-c:v", "libx264", "-preset", "ultrafast", "-tune", "zerolatency", "-g", "20", "-pix_fmt",
        "yuvj420p"}},
      {"hevc",
       {"-c:v", "libx265", "-preset", "ultrafast", "-x265-params",
        "keyint=20:open-gop=0:bframes=2:log-level=none"}},
      {"mpeg2", {"-c:v", "mpeg2video", "-g", "10", "-bf", "0"}},
  };
  int offset = 0;
  for (const auto& [name, codec] : codecs) {
    SCOPED_TRACE(name);
    const std::string port = stream_port(offset++);
    const auto sender = send_by_udp(port, codec);
    const auto source = open_when_there("udp://127.0.0.1:" + port);
    ASSERT_NE(source->info().packets, nullptr);
    begin(source->info().packets);
    keep_of(*source, 75);
    expect_all_seen_again();
    ASSERT_FALSE(parts_.empty());
    EXPECT_EQ(parts_.back().as, PicturesAs::AsTheyCame) << reasons_.back();
    source->info().line->end();
    for (const VideoPart& part : parts_) std::filesystem::remove(folder_ / part.file);
    seen_.clear(), parts_.clear(), reasons_.clear(), kept_.clear();
    ended_ = 0;
  }
}

TEST_F(StreamCopyTest, MotionJpegByRtspComesBack) {
  const std::string port = stream_port(5);
  const auto sender =
      send_by_rtsp(port,
                   "( videotestsrc is-live=true pattern=ball ! video/x-raw,format=I420,width=320,"
                   "height=240,framerate=30/1 ! jpegenc ! rtpjpegpay name=pay0 )");
  const auto source = open_when_there(rtsp_address(port));
  begin(source->info().packets);
  keep_of(*source, 60);
  expect_all_seen_again();
  ASSERT_EQ(parts_.size(), 1U);
  EXPECT_EQ(parts_[0].as, PicturesAs::AsTheyCame);
  EXPECT_EQ(parts_[0].codec, "mjpeg");
}

// By RTSP, where the parameter sets are said when one connects.
TEST_F(StreamCopyTest, H264ByRtspComesBack) {
  const test::TemporaryFolder clips;
  make_clip(clips / "clip.mkv", 300,
            {"-c:v", "libx264", "-preset", "ultrafast", "-tune", "zerolatency", "-g", "50"});
  const std::string port = stream_port(6);
  const auto sender = send_by_rtsp(port, test::h264_clip_launch(clips / "clip.mkv"));
  const auto source = open_when_there(rtsp_address(port));
  begin(source->info().packets);
  keep_of(*source, 120);
  expect_all_seen_again();
  ASSERT_EQ(parts_.size(), 1U);
  EXPECT_EQ(parts_[0].as, PicturesAs::AsTheyCame);
  // What lies on the disk is what was sent, and as much.
  EXPECT_LT(std::filesystem::file_size(folder_ / "video.mkv"),
            std::filesystem::file_size(clips / "clip.mkv") * 120 / 250);
}

// A disk that is full when a part ends is told, and ends no program: what is finished is finished once.
TEST_F(StreamCopyTest, ADiskThatIsFullAtTheEndIsTold) {
  const std::string port = stream_port(10);
  const auto sender = send_by_udp(port, {"-c:v", "mpeg2video", "-g", "10", "-bf", "0"});
  const auto source = open_when_there("udp://127.0.0.1:" + port);
  begin(source->info().packets);
  for (int i = 0; i < 40; ++i) keep(source->next());
  // What waits in the queue is on its way; then no file grows any more.
  const std::filesystem::path file = folder_ / "video.mkv";
  std::uintmax_t size = 0;
  for (std::uintmax_t before = 1; size != before || size == 0;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    before = std::exchange(size, std::filesystem::file_size(file));
  }
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  rlimit usual{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &usual), 0);
  const rlimit full{size, usual.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  std::string said;
  try {
    writer_->finish();
  } catch (const IoError& error) {
    said = error.what();
  }
  writer_.reset();
  setrlimit(RLIMIT_FSIZE, &usual);
  std::signal(SIGXFSZ, ignored);
  EXPECT_THAT(said, testing::HasSubstr("video.mkv"));
  EXPECT_EQ(ended_, 1);
}

// A sender that is killed and comes back is a new part; every picture of both is there.
TEST_F(StreamCopyTest, ABreakBeginsANewPart) {
  const std::string port = stream_port(7);
  const std::vector<std::string> codec = {"-c:v", "mpeg2video", "-g", "10", "-bf", "0"};
  auto sender = send_by_udp(port, codec);
  const auto source = open_when_there("udp://127.0.0.1:" + port);
  begin(source->info().packets);
  keep_of(*source, 40);
  sender.reset();
  // Longer than a silence that is waited through.
  const std::future<void> later = std::async(std::launch::async, [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    sender = send_by_udp(port, codec);
  });
  keep_of(*source, 80);
  later.wait();
  expect_all_seen_again();
  EXPECT_GE(parts_.size(), 2U);
  for (const VideoPart& part : parts_) EXPECT_EQ(part.as, PicturesAs::AsTheyCame);
}

// A stream that is refreshed bit by bit has no picture that decoding could begin at: what vision saw is kept
// by encoding it, without loss, and it is said why.
TEST_F(StreamCopyTest, AStreamWithoutABeginningIsEncoded) {
  const std::string port = stream_port(8);
  const auto sender = send_by_udp(port, {"-c:v", "libx264", "-preset", "ultrafast", "-tune", "zerolatency",
                                         "-g", "1000", "-x264-params", "intra-refresh=1:keyint=30"});
  // Long after its only key frame.
  std::this_thread::sleep_for(std::chrono::milliseconds(2500));
  const auto source = open_when_there("udp://127.0.0.1:" + port);
  begin(source->info().packets);
  keep_of(*source, 40);
  expect_all_seen_again();
  ASSERT_EQ(parts_.size(), 1U);
  EXPECT_EQ(parts_[0].as, PicturesAs::Lossless);
  EXPECT_THAT(reasons_[0], testing::HasSubstr("decoding could not begin"));
}

// Asked for what a source does not have: without loss, and said.
TEST_F(StreamCopyTest, ASourceWithoutEncodingIsEncoded) {
  begin(nullptr);
  auto picture = std::make_shared<camera::Frame>();
  picture->width = picture->height = 64;
  picture->bgr.assign(std::size_t{3} * 64 * 64, 90);
  keep(picture);
  expect_all_seen_again();
  ASSERT_EQ(parts_.size(), 1U);
  EXPECT_EQ(parts_[0].as, PicturesAs::Lossless);
  EXPECT_EQ(parts_[0].codec, "utvideo");
  EXPECT_THAT(reasons_[0], testing::HasSubstr("without any encoding"));
}

// Between two parts nothing is kept of what came.
TEST_F(StreamCopyTest, NothingIsKeptWhileNothingIsWanted) {
  const std::string port = stream_port(9);
  const auto sender =
      send_by_rtsp(port,
                   "( videotestsrc is-live=true pattern=ball ! video/x-raw,format=I420,width=320,"
                   "height=240,framerate=30/1 ! jpegenc ! rtpjpegpay name=pay0 )");
  const auto source = open_when_there(rtsp_address(port));
  begin(source->info().packets);
  keep_of(*source, 20);
  writer_->end_part();
  for (int i = 0; i < 20; ++i) (void)source->next();
  keep_of(*source, 20);
  expect_all_seen_again();
  ASSERT_EQ(parts_.size(), 2U);
  std::int64_t pictures = 0;
  for (const VideoPart& part : parts_) {
    sources::KeptStream video({folder_ / part.file, part.held_back, {}}, sources::KeptStream::Use::ToReplay);
    while (video.next() != nullptr) ++pictures;
  }
  // One part's first may reach back to what the opening took.
  EXPECT_LT(pictures, 60);
}

}  // namespace
}  // namespace arthronaut::recording
