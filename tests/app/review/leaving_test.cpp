// What computes of a session when that is left: the window waits for none of it.
#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <thread>

#include "app/review/review_view.h"

namespace arthronaut::review {
namespace {

// Today's program is in a step that looks at no stop: leaving the session returns while it still is, and the
// run was told to end. Only the end of the window waits for it.
TEST(Leaving, WaitsForNothingThatComputes) {
  std::latch is_in_step(1), may_end(1);
  std::atomic<bool> has_ended = false, was_told = false;
  {
    worker::LettingGo letting_go;
    let_go(nullptr, letting_go);
    auto session = std::make_unique<OpenSession>();
    session->today = std::make_unique<TodayRun>(
        [&](const auto&, const std::function<bool()>& stops) {
          is_in_step.count_down();
          may_end.wait();
          was_told = stops();
          has_ended = true;
          return TodayResult{};
        },
        [] {});
    is_in_step.wait();
    EXPECT_FALSE(session->today->is_stopping());
    let_go(std::move(session), letting_go);
    EXPECT_FALSE(has_ended);
    may_end.count_down();
  }
  EXPECT_TRUE(has_ended);
  EXPECT_TRUE(was_told);
}

// Whoever stops it is told that it is about to end, until it has.
TEST(Leaving, SaysThatItIsStopping) {
  std::latch may_end(1);
  TodayRun today(
      [&](const auto&, const auto&) {
        may_end.wait();
        TodayResult result;
        result.summary.was_stopped = true;
        return result;
      },
      [] {});
  today.stop();
  EXPECT_TRUE(today.is_stopping());
  may_end.count_down();
  while (!today.has_ended()) std::this_thread::yield();
  EXPECT_FALSE(today.is_stopping());
  ASSERT_NE(today.progress().result, nullptr);
  EXPECT_EQ(today_words(*today.progress().result), "Stopped before the first frame was compared.");
}

}  // namespace
}  // namespace arthronaut::review
