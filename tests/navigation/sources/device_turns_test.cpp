#include "navigation/sources/device_turns.h"

#include <gtest/gtest.h>

#include <atomic>
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

}  // namespace
}  // namespace arthronaut::sources
