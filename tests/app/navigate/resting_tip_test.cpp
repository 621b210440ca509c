#include "app/navigate/resting_tip.h"

#include <gtest/gtest.h>

namespace arthronaut::navigate {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// At 30 pictures a second and at 7, which is what a slow screen sees of them.
TEST(RestingTip, RestsOnceItHasStayedForATouch) {
  for (const std::int64_t between_ms : {33, 140}) {
    RestingTip tip;
    std::int64_t now_ms = 1000;
    for (int i = 0; i < 10; ++i, now_ms += between_ms) {  // 30 mm/s
      tip.follow(now_ms * kMs, Eigen::Vector3d(0.03 * static_cast<double>(now_ms), 0, 0));
      EXPECT_FALSE(tip.rests());
    }
    const std::int64_t began_ms = now_ms;
    for (; now_ms < began_ms + 1000; now_ms += between_ms) {
      tip.follow(now_ms * kMs, Eigen::Vector3d(99, 0.1, 0));  // with the tracker's noise
      EXPECT_EQ(tip.rests(), now_ms - began_ms >= 300) << now_ms - began_ms;
    }
    tip.follow(now_ms * kMs, std::nullopt);
    EXPECT_FALSE(tip.rests()) << "not seen";
    tip.follow((now_ms += between_ms) * kMs, Eigen::Vector3d(99, 0, 0));
    tip.follow(10 * kMs, Eigen::Vector3d(99, 0, 0));
    EXPECT_FALSE(tip.rests()) << "another source";
  }
}

}  // namespace
}  // namespace arthronaut::navigate
