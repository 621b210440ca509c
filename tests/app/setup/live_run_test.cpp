#include "app/setup/live_run.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "planning/geometry/error.h"

namespace arthronaut::setup {
namespace {

// Long enough for any machine: what was lost would never come.
constexpr auto kPatience = std::chrono::seconds(60);

// Counts what it is given and what is asked of it.
class Counting {
 public:
  struct Status {
    std::int64_t looks = 0, last = -1, asked = 0, worked = 0;
  };
  void look(const camera::FramePtr& frame) {
    ++status_.looks;
    status_.last = frame->index;
  }
  bool work() {
    if (status_.worked == status_.asked) return false;
    status_.worked = status_.asked;
    return true;
  }
  [[nodiscard]] bool wants_next_still() const { return true; }
  [[nodiscard]] Status status() const { return status_; }
  void ask() { ++status_.asked; }

 private:
  Status status_;
};

class Numbers : public sources::FrameSource {
 public:
  Numbers(int count, bool breaks) : count_(count), breaks_(breaks) {}
  [[nodiscard]] const sources::SourceInfo& info() const override { return info_; }
  [[nodiscard]] camera::FramePtr next() override {
    if (given_ == count_) {
      if (breaks_) throw DeviceError("the camera is gone");
      return nullptr;
    }
    auto frame = std::make_shared<camera::Frame>();
    frame->index = given_++;
    return frame;
  }

 private:
  int count_, given_ = 0;
  bool breaks_;
  sources::SourceInfo info_;
};

FeedSource numbers(int count, bool breaks = false) {
  FeedSource source;
  source.open = [=] { return std::make_unique<Numbers>(count, breaks); };
  source.newest_wins = false;
  return source;
}

using Counted = LiveRun<Counting>;

Counted run_of(const FeedSource& source) {
  return {source, [] { return std::make_unique<Counting>(); }, [] {}};
}

Counted::Status wait_for(const Counted& run, const std::function<bool(const Counted::Status&)>& is_there) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!is_there(run.status()) && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return run.status();
}

// Every picture, then the end; the job goes on taking requests.
TEST(LiveRun, LooksAtEveryPictureAndStaysOpenForRequests) {
  const Counted::Status ended = [&] {
    Counted run = run_of(numbers(20));
    (void)wait_for(run, [](const auto& status) { return status.phase == FeedPhase::Ended; });
    for (int i = 0; i < 500; ++i) run.post([](Counting& job) { job.ask(); });
    return wait_for(run, [](const auto& status) { return status.job.worked == 500; });
  }();
  EXPECT_EQ(ended.job.looks, 20);
  EXPECT_EQ(ended.job.last, 19);
  EXPECT_EQ(ended.job.worked, 500);
  EXPECT_EQ(ended.phase, FeedPhase::Ended);
}

// A source that fails says why, and what was collected can still be worked on.
TEST(LiveRun, ASourceThatFailsEndsThePicturesNotTheJob) {
  Counted run = run_of(numbers(3, true));
  const Counted::Status failed =
      wait_for(run, [](const auto& status) { return status.phase == FeedPhase::Failed; });
  EXPECT_EQ(failed.message, "the camera is gone");
  EXPECT_EQ(failed.job.looks, 3);
  run.post([](Counting& job) { job.ask(); });
  const Counted::Status worked = wait_for(run, [](const auto& status) { return status.job.worked == 1; });
  EXPECT_EQ(worked.job.worked, 1);
  EXPECT_EQ(worked.phase, FeedPhase::Failed);
}

TEST(LiveRun, AJobThatCannotBeMadeIsAState) {
  const Counted run(
      numbers(3), []() -> std::unique_ptr<Counting> { throw InvalidInput("no camera.json"); }, [] {});
  const Counted::Status failed =
      wait_for(run, [](const auto& status) { return status.phase == FeedPhase::Failed; });
  EXPECT_EQ(failed.message, "no camera.json");
}

// Stills come one after the other as the job is done with each; a source that is let go ends.
TEST(LiveRun, GoesThroughStillsAndLetsGo) {
  FeedSource source = numbers(4);
  source.is_stills = true;
  Counted run = run_of(source);
  EXPECT_EQ(wait_for(run, [](const auto& status) { return status.job.last == 3; }).job.last, 3);
  run.release_source();
  EXPECT_EQ(wait_for(run, [](const auto& status) { return status.phase == FeedPhase::Ended; }).phase,
            FeedPhase::Ended);
}

// Started and ended at once, often: an end that is missed would hang here.
TEST(LiveRun, EndsAtAnyMoment) {
  for (int round = 0; round < 500; ++round) {
    Counted run = run_of(numbers(round % 5, round % 2 == 0));
    if (round % 3 == 0) run.post([](Counting& job) { job.ask(); });
    if (round % 7 == 0) std::this_thread::sleep_for(std::chrono::microseconds(50 * (round % 11)));
  }
}

}  // namespace
}  // namespace arthronaut::setup
