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
#include <vector>

#include "navigation/sources/capture_time.h"
#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "tests/child_process.h"
#include "tests/navigation/recording/streams.h"

namespace arthronaut::sources {
namespace {

// Passes on what comes to one port of this machine to another one, but for what it is told to lose.
class LossyRelay {
 public:
  LossyRelay(const std::string& from, const std::string& to) : relay_([this, from, to] { run(from, to); }) {}
  ~LossyRelay() {
    is_ended_ = true;
    relay_.join();
  }
  LossyRelay(const LossyRelay&) = delete;
  LossyRelay& operator=(const LossyRelay&) = delete;
  void lose_next() { loses_next_ = true; }

 private:
  static sockaddr_in address_of(const std::string& port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(port)));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }
  void run(const std::string& from, const std::string& to) {
    const sockaddr_in in = address_of(from), out = address_of(to);
    const int receiver = ::socket(AF_INET, SOCK_DGRAM, 0), sender = ::socket(AF_INET, SOCK_DGRAM, 0);
    const timeval wait{.tv_sec = 0, .tv_usec = 100'000};
    ::setsockopt(receiver, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    EXPECT_EQ(::bind(receiver, reinterpret_cast<const sockaddr*>(&in), sizeof in), 0);
    std::array<char, 2048> datagram{};
    while (!is_ended_) {
      const ssize_t size = ::recv(receiver, datagram.data(), datagram.size(), 0);
      if (size <= 0 || loses_next_.exchange(false)) continue;
      ::sendto(sender, datagram.data(), static_cast<std::size_t>(size), 0,
               reinterpret_cast<const sockaddr*>(&out), sizeof out);
    }
    ::close(receiver);
    ::close(sender);
  }

  std::atomic<bool> is_ended_ = false, loses_next_ = false;
  std::thread relay_;
};

// Between two pictures that are given, of a stream that loses a datagram after 20 of them.
double longest_gap_s(const std::vector<std::string>& key_frames) {
  // Of this process alone, and none of those that streams of other tests are sent to.
  const int first = 10000 + ::getpid() * 2 % 8000;
  const std::string in = std::to_string(first), out = std::to_string(first + 1);
  LossyRelay relay(in, out);
  std::vector<std::string> arguments{
      "-re",        "-f",      "lavfi",   "-i",        "testsrc=size=320x240:rate=30,noise=alls=30:allf=t",
      "-c:v",       "libx264", "-preset", "ultrafast", "-tune",
      "zerolatency"};
  arguments.insert(arguments.end(), key_frames.begin(), key_frames.end());
  arguments.insert(arguments.end(), {"-f", "mpegts", "udp://127.0.0.1:" + in + "?pkt_size=1316"});
  const test::ChildProcess sender(test::run_ffmpeg(arguments));
  const auto source = open_source("udp://127.0.0.1:" + out);
  double longest_s = 0;
  const auto picture = [&] {
    camera::FramePtr given = source->next();
    if (given == nullptr) throw DeviceError("the stream has ended");
    return given;
  };
  camera::FramePtr last = picture();
  constexpr int kLostAfter = 20, kPictures = 60;
  for (int i = 0; i < kPictures; ++i) {
    if (i == kLostAfter) relay.lose_next();
    camera::FramePtr next = picture();
    longest_s = std::max(longest_s, static_cast<double>(next->timestamp_ns - last->timestamp_ns) * 1e-9);
    last = std::move(next);
  }
  return longest_s;
}

// After a loss every picture up to the next key frame rests on what did not come, and passes for whole: none
// of them is given. A key frame comes every 60 pictures here, and the first that is given is one.
TEST(Stream, WhatRestsOnALostPictureIsNotGiven) {
  const double gap_s = longest_gap_s({"-g", "60"});
  EXPECT_GT(gap_s, 0.4);
  EXPECT_LT(gap_s, 1.5);
}

// Many a camera sends no key frame but the first, and renews a part of every picture instead, here all of it
// within 30: what is lost is given again when all parts are new.
TEST(Stream, APictureThatIsRenewedInPartsIsGivenAgainWhenItIsWhole) {
  const double gap_s = longest_gap_s({"-x264-params", "intra-refresh=1:keyint=30"});
  EXPECT_GT(gap_s, 0.2);
  EXPECT_LT(gap_s, 3);
}

}  // namespace
}  // namespace arthronaut::sources
