#include "navigation/pipeline/prefetched_source.h"

#include <gtest/gtest.h>

#include "navigation/pipeline/bounded_queue.h"
#include "planning/geometry/error.h"
#include "tests/navigation/pipeline/scripted_markers.h"

namespace arthronaut {
namespace {

// Gives `count` frames, then ends or fails.
class CountingSource : public sources::FrameSource {
 public:
  CountingSource(int count, bool fails) : count_(count), fails_(fails) {}
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
