// How old a stream's pictures are said to be, against when they were sent.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "navigation/sources/capture_time.h"
#include "navigation/sources/frame_source.h"
#include "planning/geometry/quantile.h"
#include "tests/child_process.h"
#include "tests/navigation/recording/streams.h"
#include "tests/temporary_folder.h"

namespace arthronaut::sources {
namespace {

// A program sending plain pictures, ten a second, as they are pushed into it: each of another grey.
class PushedSender {
 public:
  static constexpr int kSide = 64, kGreys = 20;

  // Starts it with what it is to read.
  using Start = std::function<std::unique_ptr<test::ChildProcess>(int input)>;
  explicit PushedSender(const Start& start) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    process_ = start(ends[0]);
    ::close(ends[0]);
    to_ = ends[1];
  }
  ~PushedSender() { ::close(to_); }
  PushedSender(const PushedSender&) = delete;
  PushedSender& operator=(const PushedSender&) = delete;

  void push(int number) const {
    const std::vector<char> picture(std::size_t{kSide} * kSide,
                                    static_cast<char>(30 + 10 * (number % kGreys)));
    if (::write(to_, picture.data(), picture.size()) < 0) throw std::runtime_error("the sender is gone");
  }
  // is_stretched: by a sender that takes what is pushed for luma of 16 to 235.
  static int number_of(const camera::Frame& frame, bool is_stretched) {
    std::vector<std::uint8_t> gray;
    const camera::GrayView luma = camera::luma_of(frame, gray);
    const int seen = luma.row(kSide / 2)[kSide / 2];
    return ((is_stretched ? 16 + seen * 219 / 255 : seen) - 25) / 10;
  }

 private:
  std::unique_ptr<test::ChildProcess> process_;
  int to_ = -1;
};

struct Ages {
  double said_s;   // captured, by its stamp, after it was pushed: what is not seen of its way
  double taken_s;  // handed out after it was pushed
};

// Each picture is known by its grey; medians of what came once the quickest was known.
Ages ages_of(const PushedSender::Start& start, const std::string& address, bool is_stretched = false) {
  const PushedSender sender(start);
  std::mutex mutex;
  std::vector<std::int64_t> pushed_ns;
  std::jthread hand([&](const std::stop_token& stop) {
    auto due = std::chrono::steady_clock::now();
    for (int i = 0; !stop.stop_requested(); ++i) {
      std::this_thread::sleep_until(due += std::chrono::milliseconds(100));
      {
        const std::lock_guard lock(mutex);
        pushed_ns.push_back(steady_now_ns());
      }
      sender.push(i);
    }
  });
  const auto source = test::open_when_there(address);
  std::vector<double> said_s, taken_s;
  for (int i = 0; i < 20; ++i) {
    const camera::FramePtr frame = source->next();
    const std::int64_t now_ns = steady_now_ns();
    const std::lock_guard lock(mutex);
    // The newest of that grey.
    int number = PushedSender::number_of(*frame, is_stretched);
    while (number + PushedSender::kGreys < static_cast<int>(pushed_ns.size())) number += PushedSender::kGreys;
    if (i < 6) continue;
    const std::int64_t at_ns = pushed_ns.at(static_cast<std::size_t>(number));
    said_s.push_back(1e-9 * static_cast<double>(frame->captured_ns - at_ns));
    taken_s.push_back(1e-9 * static_cast<double>(now_ns - at_ns));
  }
  return {geometry::median(said_s, 0), geometry::median(taken_s, 0)};
}

// MPEG-TS by UDP. No codec of these keeps a picture back for itself.
Ages ages_by_udp(const std::string& codec, const std::string& port) {
  const std::string address = "udp://127.0.0.1:" + port;
  std::vector<std::string> words = {"ffmpeg"};
  std::istringstream options(
      "-loglevel quiet -f rawvideo -pix_fmt gray -s 64x64 -r 10 -i - -c:v " + codec +
      " -tune zerolatency -flags low_delay -g 5 -bf 0 -pix_fmt yuv420p -flush_packets 1 -f mpegts " +
      address + "?pkt_size=1316");
  for (std::string word; options >> word;) words.push_back(word);
  return ages_of(
      [&](int input) {
        return std::make_unique<test::ChildProcess>(test::run_program(words, STDOUT_FILENO, input));
      },
      address);
}

// A picture in MPEG-TS is looked at once its last byte is there, and not when the one after the next begins,
// 200 ms later here; and it is not said to be any younger than it is.
TEST(Stream, Hazard3APictureWaitsForNoOtherOne) {
  const Ages ages = ages_by_udp("libx264", test::stream_port(0));
  EXPECT_NEAR(ages.said_s, 0.03, 0.05);
  EXPECT_LT(ages.taken_s, 0.1);
}

// Nor by RTSP, where the mark of a picture's last packet tells it, and not the next picture 100 ms later.
TEST(Stream, Hazard3APictureByRtspWaitsForNoOtherOne) {
  const std::string port = test::stream_port(1);
  const std::string launch =
      "( fdsrc fd=0 blocksize=4096 do-timestamp=true ! rawvideoparse width=64 height=64 format=gray8 "
      "framerate=10/1 ! videoconvert ! openh264enc gop-size=5 ! rtph264pay name=pay0 config-interval=-1 )";
  const Ages ages = ages_of([&](int input) { return test::send_by_rtsp(port, launch, input); },
                            test::rtsp_address(port), true);
  EXPECT_NEAR(ages.said_s, 0.03, 0.05);
  EXPECT_LT(ages.taken_s, 0.07);
}

// Where packets may be more or less than one picture libavformat puts pictures together, and gives one out
// when it has seen the one after the next begin: the age says so.
TEST(Stream, Hazard3AnAgeCountsThePicturesThatAreHeldBack) {
  const Ages ages = ages_by_udp("mpeg2video", test::stream_port(2));
  EXPECT_NEAR(ages.said_s, 0.03, 0.05);
  EXPECT_GT(ages.taken_s, 0.15);
}

// Sends a clip of MPEG-TS to a port of this machine as a sender does that is stopped and started again at
// once: in as many seconds as it lasts, and over and over, each time with the same stamps.
class RestartedSender {
 public:
  RestartedSender(const std::filesystem::path& clip, double clip_s, const std::string& port)
      : sends_([clip, clip_s, port](const std::stop_token& stop) {
          std::ifstream file(clip, std::ios::binary);
          const std::string bytes((std::istreambuf_iterator<char>(file)), {});
          sockaddr_in to{};
          to.sin_family = AF_INET;
          to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(port)));
          to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
          const int sender = ::socket(AF_INET, SOCK_DGRAM, 0);
          const auto begin = std::chrono::steady_clock::now();
          constexpr std::size_t kPacket = 188;
          for (std::size_t sent = 0; !stop.stop_requested(); sent += kPacket) {
            ::sendto(sender, bytes.data() + sent % bytes.size(), kPacket, 0,
                     reinterpret_cast<const sockaddr*>(&to), sizeof to);
            std::this_thread::sleep_until(begin +
                                          std::chrono::duration<double>(clip_s * static_cast<double>(sent) /
                                                                        static_cast<double>(bytes.size())));
          }
          ::close(sender);
        }) {}

 private:
  std::jthread sends_;
};

// A sender that begins its stamps anew while pictures from before wait to be put in order: these are as old
// as they are and none is of the future, and the time goes on as fast as before.
TEST(Stream, Hazard3StampsThatBeginAnewDateNoPictureIntoTheFuture) {
  const test::TemporaryFolder folder;
  const std::filesystem::path clip = folder / "clip.ts";
  constexpr int kClip = 120;
  test::make_clip(clip, kClip, {"-c:v", "libx264", "-bf", "3", "-g", "30", "-b:v", "1M", "-f", "mpegts"});
  const std::string port = test::stream_port(3);
  const RestartedSender sender(clip, kClip / 30.0, port);
  const auto source = test::open_when_there("udp://127.0.0.1:" + port);
  camera::FramePtr first;
  double furthest_apart_s = 0;
  for (int i = 0; i < 2 * kClip + 60; ++i) {
    const camera::FramePtr frame = source->next();
    ASSERT_NE(frame, nullptr);
    EXPECT_LE(frame->captured_ns, frame->received_ns) << i;
    if (first == nullptr) first = frame;
    const double passed_s = 1e-9 * static_cast<double>(frame->received_ns - first->received_ns);
    const double counted_s = 1e-9 * static_cast<double>(frame->timestamp_ns - first->timestamp_ns);
    furthest_apart_s = std::max(furthest_apart_s, std::abs(passed_s - counted_s));
  }
  EXPECT_LT(furthest_apart_s, 0.5);
}

}  // namespace
}  // namespace arthronaut::sources
