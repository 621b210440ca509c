#include "navigation/sources/device_turns.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <string>
#include <thread>

#include "planning/geometry/error.h"
#include "tests/message_of.h"

namespace arthronaut::sources {
namespace {

using test::message_of;

constexpr double kLong_s = 60, kShort_s = 0.01;

// A camera that must never be open twice.
class ToyCamera : public FrameSource {
 public:
  explicit ToyCamera(std::atomic<int>& open_count) : open_count_(open_count) {
    if (++open_count_ > 1) was_open_twice = true;
  }
  ~ToyCamera() override { --open_count_; }
  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] camera::FramePtr next() override { return nullptr; }
  static inline std::atomic<bool> was_open_twice = false;

 private:
  std::atomic<int>& open_count_;
  SourceInfo info_;
};

// A device that is still being let go of is opened again only afterwards, never both at once.
TEST(DeviceTurns, TheNextOpeningWaitsForTheOneBefore) {
  std::atomic<int> open_count = 0;
  const DeviceTurns turns([&](const CameraAddress&) { return std::make_unique<ToyCamera>(open_count); },
                          kLong_s);
  std::unique_ptr<FrameSource> first = turns.open({0});
  std::atomic<bool> has_second = false;
  std::jthread next([&] {
    const std::unique_ptr<FrameSource> second = turns.open({0});
    has_second = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(has_second);
  first.reset();
  next.join();
  EXPECT_TRUE(has_second);
  EXPECT_FALSE(ToyCamera::was_open_twice);
}

// One that is read on is refused with the reason; others are free, and so is it when an opening fails.
TEST(DeviceTurns, SaysThatADeviceIsInUse) {
  std::atomic<int> open_count = 0;
  const DeviceTurns turns(
      [&](const CameraAddress& address) -> std::unique_ptr<FrameSource> {
        if (address.index == 7) throw DeviceError("camera 7: can't be opened");
        return std::make_unique<ToyCamera>(open_count);
      },
      kShort_s);
  const std::unique_ptr<FrameSource> first = turns.open({0});
  EXPECT_NE(message_of<DeviceError>([&] { (void)turns.open({0}); }).find("camera 0 is in use"),
            std::string::npos);
  EXPECT_NE(turns.open({1}), nullptr);
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(message_of<DeviceError>([&] { (void)turns.open({7}); }), "camera 7: can't be opened");
}

// A port that a preview still listens on is waited for: opened beside it the stream fails ("Address already
// in use"), and with it the source that somebody has just chosen by what the preview showed.
TEST(DeviceTurns, AStreamWaitsForWhoStillLooksAtIt) {
  const int sender = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in free_port{};
  free_port.sin_family = AF_INET;
  free_port.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof free_port;
  ASSERT_EQ(::bind(sender, reinterpret_cast<const sockaddr*>(&free_port), size), 0);
  ASSERT_EQ(::getsockname(sender, reinterpret_cast<sockaddr*>(&free_port), &size), 0);
  ::close(sender);
  const std::string port = std::to_string(ntohs(free_port.sin_port)), address = "udp://127.0.0.1:" + port;
  FILE* const stream =
      ::popen(("exec ffmpeg -v error -re -f lavfi -i testsrc=s=320x240:r=30 -c:v libx264 -tune "
               "zerolatency -g 10 -pix_fmt yuv420p -f mpegts " +
               address)
                  .c_str(),
              "w");
  ASSERT_NE(stream, nullptr);
  const DeviceTurns turns(open_camera, kLong_s);
  std::unique_ptr<FrameSource> preview = turns.open_stream_if_free(address);
  EXPECT_NE(message_of<DeviceError>([&] { (void)turns.open_stream_if_free(address); }).find("in use"),
            std::string::npos);
  std::atomic<bool> is_open = false;
  std::jthread next([&] {
    try {
      is_open = turns.open_stream(address)->next() != nullptr;
    } catch (const DeviceError&) {  // is_open stays false
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  preview.reset();
  next.join();
  EXPECT_TRUE(is_open);
  std::fputs("q", stream);  // ends ffmpeg
  ::pclose(stream);
}

}  // namespace
}  // namespace arthronaut::sources
