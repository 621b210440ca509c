// A stream of which something is lost on its way.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <thread>
#include <utility>

#include "navigation/sources/capture_time.h"
#include "navigation/sources/frame_source.h"
#include "tests/child_process.h"
#include "tests/navigation/recording/streams.h"

namespace arthronaut::sources {
namespace {

// Passes on what comes to one port of this machine to another one, but for a single datagram.
class LossyRelay {
 public:
  LossyRelay(const std::string& from, const std::string& to, double lost_after_s)
      : relay_([this, from, to, lost_after_s] { run(from, to, lost_after_s); }) {}
  ~LossyRelay() {
    is_ended_ = true;
    relay_.join();
  }
  LossyRelay(const LossyRelay&) = delete;
  LossyRelay& operator=(const LossyRelay&) = delete;

 private:
  static sockaddr_in address_of(const std::string& port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(port)));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }
  void run(const std::string& from, const std::string& to, double lost_after_s) {
    const sockaddr_in in = address_of(from), out = address_of(to);
    const int receiver = ::socket(AF_INET, SOCK_DGRAM, 0), sender = ::socket(AF_INET, SOCK_DGRAM, 0);
    const timeval wait{.tv_sec = 0, .tv_usec = 100'000};
    ::setsockopt(receiver, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    EXPECT_EQ(::bind(receiver, reinterpret_cast<const sockaddr*>(&in), sizeof in), 0);
    std::array<char, 2048> datagram{};
    std::int64_t first_ns = 0;
    bool is_lost = false;
    while (!is_ended_) {
      const ssize_t size = ::recv(receiver, datagram.data(), datagram.size(), 0);
      if (size <= 0) continue;
      const std::int64_t now_ns = steady_now_ns();
      if (first_ns == 0) first_ns = now_ns;
      if (!is_lost && static_cast<double>(now_ns - first_ns) * 1e-9 > lost_after_s) {
        is_lost = true;
        continue;
      }
      ::sendto(sender, datagram.data(), static_cast<std::size_t>(size), 0,
               reinterpret_cast<const sockaddr*>(&out), sizeof out);
    }
    ::close(receiver);
    ::close(sender);
  }

  std::atomic<bool> is_ended_ = false;
  std::thread relay_;
};

// After a loss every picture up to the next key frame rests on what did not come, and passes for whole: none
// of them is given. A key frame comes every 2 s here, and what is lost is lost 1.2 s after one.
TEST(Stream, WhatRestsOnALostPictureIsNotGiven) {
  // Of this process alone, and none of those that streams of other tests are sent to.
  const int first = 10000 + ::getpid() * 2 % 8000;
  const std::string in = std::to_string(first), out = std::to_string(first + 1);
  const LossyRelay relay(in, out, 1.2);
  const test::ChildProcess sender(
      test::run_ffmpeg({"-re", "-f", "lavfi", "-i", "testsrc=size=320x240:rate=30,noise=alls=30:allf=t",
                        "-c:v", "libx264", "-preset", "ultrafast", "-tune", "zerolatency", "-g", "60", "-f",
                        "mpegts", "udp://127.0.0.1:" + in + "?pkt_size=1316"}));
  const auto source = open_source("udp://127.0.0.1:" + out);
  double longest_s = 0;
  camera::FramePtr last = source->next();
  for (int i = 0; i < 60; ++i) {
    camera::FramePtr next = source->next();
    longest_s = std::max(longest_s, static_cast<double>(next->timestamp_ns - last->timestamp_ns) * 1e-9);
    last = std::move(next);
  }
  EXPECT_GT(longest_s, 0.4);
  EXPECT_LT(longest_s, 1.5);
}

}  // namespace
}  // namespace arthronaut::sources
