#include "app/window/draw_watch.h"

#include <gtest/gtest.h>

#include <mutex>
#include <thread>
#include <vector>

namespace arthronaut::window {
namespace {

using namespace std::chrono_literals;

struct Told {
  std::mutex mutex;
  std::vector<std::string> lines;
  [[nodiscard]] std::vector<std::string> all() {
    const std::lock_guard lock(mutex);
    return lines;
  }
  DrawWatch::Tell tell() {
    return [this](const std::string& what) {
      const std::lock_guard lock(mutex);
      lines.push_back(what);
    };
  }
  // Slow machines are waited for.
  [[nodiscard]] bool has(std::size_t count) {
    for (int i = 0; i < 500 && all().size() < count; ++i) std::this_thread::sleep_for(10ms);
    return all().size() == count;
  }
};

// A draw loop that stands still is written down by a thread of its own while it still stands, once, and once
// more when it moves again.
TEST(DrawWatchHazard17, WritesDownAScreenThatStandsStill) {
  Told told;
  DrawWatch watch(told.tell(), 50ms);
  watch.frame_drawn(true);
  ASSERT_TRUE(told.has(1));
  EXPECT_NE(told.all()[0].find("stood still"), std::string::npos) << told.all()[0];
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(told.all().size(), 1U);
  watch.frame_drawn(false);
  ASSERT_TRUE(told.has(2));
  EXPECT_NE(told.all()[1].find("moves again"), std::string::npos) << told.all()[1];
}

// Without an operation nobody is to be told.
TEST(DrawWatchHazard17, IsSilentWhileNothingRuns) {
  Told told;
  DrawWatch watch(told.tell(), 20ms);
  std::this_thread::sleep_for(100ms);
  watch.frame_drawn(false);
  std::this_thread::sleep_for(150ms);
  EXPECT_TRUE(told.all().empty());
}

}  // namespace
}  // namespace arthronaut::window
