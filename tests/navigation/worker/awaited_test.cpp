#include "navigation/worker/awaited.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>

namespace arthronaut::worker {
namespace {

// Whoever is woken finds the result there, whether the work returned or threw.
TEST(Awaited, IsReadyWhenItWakes) {
  for (const bool throws : {false, true}) {
    std::promise<bool> woken;
    Awaited<int> awaited;
    EXPECT_FALSE(awaited.is_busy());
    awaited.start(
        [throws] {
          if (throws) throw std::runtime_error("why");
          return 7;
        },
        [&] { woken.set_value(awaited.is_ready()); });
    EXPECT_TRUE(awaited.is_busy());
    EXPECT_TRUE(woken.get_future().get());
    if (throws) {
      EXPECT_THROW((void)awaited.take(), std::runtime_error);
    } else {
      EXPECT_EQ(awaited.take(), 7);
    }
    EXPECT_FALSE(awaited.is_busy());
    EXPECT_FALSE(awaited.is_ready());
  }
}

// One after the other; a result need not be copied, and may be none.
TEST(Awaited, StartsAgain) {
  Awaited<std::unique_ptr<int>> awaited;
  for (int i = 0; i < 100; ++i) {
    awaited.start([i] { return std::make_unique<int>(i); }, [] {});
    EXPECT_EQ(*awaited.take(), i);
  }
  Awaited<void> none;
  none.start([] {}, [] {});
  none.take();
  EXPECT_FALSE(none.is_busy());
}

// What the work and the call at its end use may go right after it, and what is dropped is not taken.
TEST(Awaited, WaitsForItsEnd) {
  std::atomic<int> ended = 0;
  const auto work = [] { std::this_thread::yield(); };
  const auto on_end = [&] { ++ended; };
  {
    Awaited<void> awaited;
    awaited.start(work, on_end);
    awaited.drop();
    EXPECT_EQ(ended, 1);
    EXPECT_FALSE(awaited.is_busy());
    awaited.start(work, on_end);
    awaited.start(work, on_end);
    EXPECT_GE(ended, 2) << "the one before";
  }
  EXPECT_EQ(ended, 3);
}

}  // namespace
}  // namespace arthronaut::worker
