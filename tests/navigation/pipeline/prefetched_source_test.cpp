#include "navigation/pipeline/prefetched_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

#include "navigation/pipeline/bounded_queue.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/navigation/pipeline/scripted_markers.h"

namespace arthronaut {
namespace {

// Gives `count` frames, then ends or fails.
class CountingSource : public sources::FrameSource {
 public:
  CountingSource(int count, bool fails, sources::SourceKind kind = sources::SourceKind::Recording)
      : count_(count), fails_(fails) {
    info_.kind = kind;
  }
  const sources::SourceInfo& info() const override { return info_; }
  camera::FramePtr next() override {
    if (given_ < count_) return std::make_shared<camera::Frame>(test::plain_frame(given_++, 1));
    if (fails_) throw InvalidInput("clip.mkv", "frame " + std::to_string(count_), "breaks off");
    return nullptr;
  }

 private:
  sources::SourceInfo info_;
  int count_, given_ = 0;
  bool fails_;
};

// The thread in between neither loses nor reorders a frame.
TEST(PrefetchedSource, GivesTheSameFramesInOrder) {
  CountingSource source(50, false);
  pipeline::PrefetchedSource prefetched(source);
  for (int i = 0; i < 50; ++i) {
    const camera::FramePtr frame = prefetched.next();
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->index, i);
  }
  EXPECT_EQ(prefetched.next(), nullptr);
  EXPECT_EQ(prefetched.next(), nullptr);
}

// Frames before an error are still given; then the error comes where the frame would have come.
TEST(PrefetchedSource, PassesAnErrorOnAfterTheFramesBeforeIt) {
  CountingSource source(6, true);
  pipeline::PrefetchedSource prefetched(source);
  for (int i = 0; i < 6; ++i) ASSERT_NE(prefetched.next(), nullptr);
  EXPECT_THROW((void)prefetched.next(), InvalidInput);
}

// Who stops early does not hang.
TEST(PrefetchedSource, CanBeLeftInTheMiddle) {
  CountingSource source(1000, false);
  pipeline::PrefetchedSource prefetched(source);
  EXPECT_NE(prefetched.next(), nullptr);
}

// A camera under the test's control: gives a picture whenever one is released.
class GatedCamera : public sources::FrameSource {
 public:
  explicit GatedCamera(sources::SourceKind kind) { info_.kind = kind; }
  const sources::SourceInfo& info() const override { return info_; }
  camera::FramePtr next() override {
    std::unique_lock lock(mutex_);
    ++asked_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return released_ > given_ || ended_; });
    if (released_ == given_) return nullptr;
    return std::make_shared<camera::Frame>(test::plain_frame(given_++, 1));
  }
  // Returns when the pictures have been handed over: the reader asks for the one after them.
  void release(int count) {
    std::unique_lock lock(mutex_);
    released_ += count;
    changed_.notify_all();
    changed_.wait(lock, [&] { return asked_ > released_; });
  }
  void end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }

 private:
  sources::SourceInfo info_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int asked_ = 0, released_ = 0, given_ = 0;
  bool ended_ = false;
};

// A consumer who was held up for less than 50 ms gets what came meanwhile. A machine that holds this test up
// for as long tells nothing.
TEST(LatePicture, IsCaughtUpWithAfterAMoment) {
  for (int attempt = 0; attempt < 50; ++attempt) {
    GatedCamera camera(sources::SourceKind::Live);
    pipeline::PrefetchedSource prefetched(camera);
    const auto begin = std::chrono::steady_clock::now();
    camera.release(4);
    std::vector<std::int64_t> given;
    while (const camera::FramePtr frame = prefetched.next_within(0).frame) given.push_back(frame->index);
    const bool was_quick = std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(50);
    camera.end();
    if (!was_quick) continue;
    EXPECT_EQ(given, (std::vector<std::int64_t>{0, 1, 2, 3}));
    return;
  }
  FAIL() << "fifty times in a row this took 50 ms";
}

// Of pictures that waited for longer the newest alone, and until somebody has waited for one no other one is
// kept.
TEST(LatePicture, OlderThanAMomentIsLeftOut) {
  GatedCamera camera(sources::SourceKind::Live);
  pipeline::PrefetchedSource prefetched(camera);
  camera.release(3);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  EXPECT_EQ(prefetched.next()->index, 2);
  camera.release(2);
  EXPECT_EQ(prefetched.next()->index, 4);
  EXPECT_EQ(prefetched.next_within(0).frame, nullptr);
  camera.end();
}

// Of a live source only the newest picture is delivered where more came during the work on the one before
// than can be caught up with, and never one twice.
TEST(LatePicture, IsLeftOutOfALiveSource) {
  GatedCamera camera(sources::SourceKind::Live);
  pipeline::PrefetchedSource prefetched(camera);
  int newest = -1;
  for (const int came_meanwhile : {1, 7, 1, 40, 5}) {
    camera.release(came_meanwhile);
    newest += came_meanwhile;
    EXPECT_EQ(prefetched.next()->index, newest);
    EXPECT_EQ(prefetched.next_within(0).frame, nullptr);
  }
  camera.end();
  EXPECT_EQ(prefetched.next(), nullptr);
}

// A camera that gives a picture every 20 ms, before a consumer who works for 70 ms: when a picture is handed
// over it is no older than an interval, and an interval and the work when the work is done. (The median of
// 20, with 20 ms for the scheduler of a busy machine; a queue of four would be 300 ms behind.)
TEST(LatePicture, IsNeverOlderThanAnIntervalAndTheWork) {
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kInterval{20}, kWork{70}, kScheduler{20};
  class Ticking : public sources::FrameSource {
   public:
    Ticking() { info_.kind = sources::SourceKind::Live; }
    const sources::SourceInfo& info() const override { return info_; }
    camera::FramePtr next() override {
      due_ = std::max(due_ + kInterval, Clock::now());
      std::this_thread::sleep_until(due_);
      auto frame = std::make_shared<camera::Frame>(test::plain_frame(index_++, 1));
      frame->captured_ns = std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
      return frame;
    }

   private:
    sources::SourceInfo info_;
    Clock::time_point due_ = Clock::now();
    std::int64_t index_ = 0;
  } camera;
  pipeline::PrefetchedSource prefetched(camera);
  std::vector<double> handed_over_ms, done_ms;
  const auto age_ms = [](const camera::Frame& frame) {
    return static_cast<double>(std::chrono::nanoseconds(Clock::now().time_since_epoch()).count() -
                               frame.captured_ns) *
           1e-6;
  };
  for (int i = 0; i < 20; ++i) {
    const camera::FramePtr frame = prefetched.next();
    handed_over_ms.push_back(age_ms(*frame));
    std::this_thread::sleep_for(kWork);
    done_ms.push_back(age_ms(*frame));
  }
  const auto median = [](std::vector<double>& values) {
    std::nth_element(values.begin(), values.begin() + 10, values.end());
    return values[10];
  };
  EXPECT_LE(median(handed_over_ms), (kInterval + kScheduler).count());
  EXPECT_LE(median(done_ms), (kInterval + kWork + kScheduler).count());
}

// Nothing is left out of a recording or a simulation, however slow the consumer is.
TEST(LatePicture, IsKeptOfARecordingAndOfASimulation) {
  for (const auto kind : {sources::SourceKind::Recording, sources::SourceKind::Simulation}) {
    CountingSource source(20, false, kind);
    pipeline::PrefetchedSource prefetched(source);
    for (int i = 0; i < 20; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      EXPECT_EQ(prefetched.next()->index, i);
    }
    EXPECT_EQ(prefetched.next(), nullptr);
  }
}

// What a source that was left behind still holds on to; lets it go at the end of the test.
struct Stall {
  std::promise<void> end;
  std::shared_future<void> ended = end.get_future().share();
  ~Stall() { end.set_value(); }
};

// Opening hangs: after the patience it is an error with words, and nobody waits for the thread.
TEST(StalledSource, ThatDoesNotOpenIsGivenUp) {
  const Stall stall;
  const auto begin = std::chrono::steady_clock::now();
  const std::string message = test::message_of<DeviceError>([&] {
    const pipeline::PrefetchedSource prefetched(
        [ended = stall.ended]() -> std::unique_ptr<sources::FrameSource> {
          ended.wait();
          return std::make_unique<CountingSource>(1, false);
        },
        0.05);
  });
  EXPECT_EQ(message, "the source does not answer: it was not open after 0.05 s");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500));
}

// A source that hangs in the middle: the pictures before are given, then it is told without a wait where one
// asks so, as an error where one asks for a picture, and leaving takes no time.
TEST(StalledSource, ThatGivesNoPictureIsToldAndLeft) {
  class Stalling : public CountingSource {
   public:
    explicit Stalling(std::shared_future<void> ended) : CountingSource(2, false), ended_(std::move(ended)) {}
    camera::FramePtr next() override {
      if (camera::FramePtr frame = CountingSource::next()) return frame;
      ended_.wait();
      return nullptr;
    }

   private:
    std::shared_future<void> ended_;
  };
  const Stall stall;
  const auto begin = std::chrono::steady_clock::now();
  {
    pipeline::PrefetchedSource prefetched([ended = stall.ended] { return std::make_unique<Stalling>(ended); },
                                          0.05);
    EXPECT_EQ(prefetched.next()->index, 0);
    EXPECT_EQ(prefetched.next()->index, 1);
    const pipeline::NextFrame late = prefetched.next_within(0.01);
    EXPECT_EQ(late.frame, nullptr);
    EXPECT_FALSE(late.has_ended);
    EXPECT_NE(test::message_of<DeviceError>([&] { (void)prefetched.next(); }).find("no picture for 0.05 s"),
              std::string::npos);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500));
}

// What the opener complains of comes out as it is; a source that was opened so plays to its end.
TEST(PrefetchedSource, OpensASourceOfItsOwn) {
  constexpr double kLong_s = 60;
  EXPECT_THROW(
      pipeline::PrefetchedSource(
          []() -> std::unique_ptr<sources::FrameSource> { throw IoError("clip.mkv", "no such file"); },
          kLong_s),
      IoError);
  pipeline::PrefetchedSource prefetched([] { return std::make_unique<CountingSource>(9, false); }, kLong_s);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(prefetched.next()->index, i);
  EXPECT_EQ(prefetched.next(), nullptr);
  EXPECT_TRUE(prefetched.next_within(0).has_ended);
}

// A full queue refuses rather than loses; a closed one still gives what is in it.
TEST(BoundedQueue, IsLosslessAndCloses) {
  pipeline::BoundedQueue<int> queue(2);
  EXPECT_TRUE(queue.try_push(1));
  EXPECT_TRUE(queue.push(2));
  EXPECT_FALSE(queue.try_push(3));
  queue.close();
  EXPECT_FALSE(queue.push(4));
  EXPECT_FALSE(queue.is_drained());
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), 2);
  EXPECT_EQ(queue.pop(), std::nullopt);
  EXPECT_TRUE(queue.is_drained());
}

}  // namespace
}  // namespace arthronaut
