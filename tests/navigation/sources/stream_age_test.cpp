// How old a stream's pictures are said to be, against when they were sent.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "navigation/sources/capture_time.h"
#include "navigation/sources/frame_source.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::sources {
namespace {

// ffmpeg sending plain pictures in MPEG-TS, ten a second, as they are pushed into it: each of another grey.
// No codec of these keeps one back for itself.
class PushedSender {
 public:
  static constexpr int kSide = 64, kGreys = 20;

  PushedSender(const std::string& address, const std::string& codec) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    process_ = ::fork();
    if (process_ == 0) {
      ::dup2(ends[0], STDIN_FILENO);
      const std::string target = address + "?pkt_size=1316";
      ::execlp("ffmpeg", "ffmpeg", "-loglevel", "quiet", "-f", "rawvideo", "-pix_fmt", "gray", "-s", "64x64",
               "-r", "10", "-i", "-", "-c:v", codec.c_str(), "-tune", "zerolatency", "-flags", "low_delay",
               "-g", "5", "-bf", "0", "-pix_fmt", "yuv420p", "-flush_packets", "1", "-f", "mpegts",
               target.c_str(), static_cast<char*>(nullptr));
      ::_exit(127);
    }
    ::close(ends[0]);
    to_ = ends[1];
  }
  ~PushedSender() {
    ::close(to_);
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  PushedSender(const PushedSender&) = delete;
  PushedSender& operator=(const PushedSender&) = delete;

  void push(int number) const {
    const std::vector<char> picture(std::size_t{kSide} * kSide,
                                    static_cast<char>(30 + 10 * (number % kGreys)));
    if (::write(to_, picture.data(), picture.size()) < 0) throw std::runtime_error("the sender is gone");
  }
  static int number_of(const camera::Frame& frame) {
    std::vector<std::uint8_t> gray;
    const camera::GrayView luma = camera::luma_of(frame, gray);
    return (luma.row(kSide / 2)[kSide / 2] - 25) / 10;
  }

 private:
  pid_t process_ = -1;
  int to_ = -1;
};

struct Ages {
  double said_s;   // captured, by its stamp, after it was pushed: what is not seen of its way
  double taken_s;  // handed out after it was pushed
};

// Each picture is known by its grey; medians of what came once the quickest was known.
Ages ages_of(const std::string& codec, int port) {
  const std::string address = "udp://127.0.0.1:" + std::to_string(20000 + (::getpid() + port) % 40000);
  const PushedSender sender(address, codec);
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
  const auto source = open_source(address);
  std::vector<double> said_s, taken_s;
  for (int i = 0; i < 20; ++i) {
    const camera::FramePtr frame = source->next();
    const std::int64_t now_ns = steady_now_ns();
    const std::lock_guard lock(mutex);
    // The newest of that grey.
    int number = PushedSender::number_of(*frame);
    while (number + PushedSender::kGreys < static_cast<int>(pushed_ns.size())) number += PushedSender::kGreys;
    const std::int64_t at_ns = pushed_ns[static_cast<std::size_t>(number)];
    if (i < 6) continue;
    said_s.push_back(1e-9 * static_cast<double>(frame->captured_ns - at_ns));
    taken_s.push_back(1e-9 * static_cast<double>(now_ns - at_ns));
  }
  return {geometry::median(said_s, 0), geometry::median(taken_s, 0)};
}

// A picture in MPEG-TS is looked at once its last byte is there, and not when the one after the next begins,
// 200 ms later here; and it is not said to be any younger than it is.
TEST(Stream, Hazard3APictureWaitsForNoOtherOne) {
  const Ages ages = ages_of("libx264", 0);
  EXPECT_NEAR(ages.said_s, 0.03, 0.05);
  EXPECT_LT(ages.taken_s, 0.1);
}

// Where packets may be more or less than one picture libavformat puts pictures together, and gives one out
// when it has seen the one after the next begin: the age says so.
TEST(Stream, Hazard3AnAgeCountsThePicturesThatAreHeldBack) {
  const Ages ages = ages_of("mpeg2video", 1);
  EXPECT_NEAR(ages.said_s, 0.03, 0.05);
  EXPECT_GT(ages.taken_s, 0.15);
}

}  // namespace
}  // namespace arthronaut::sources
