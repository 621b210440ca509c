#include "app/paint/label_job.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>

namespace arthronaut::paint {
namespace {

using painting::Labels;

void wait_for_end(LabelJob& job, std::optional<LabelJob::Done>& done) {
  for (int i = 0; i < 4000 && job.is_running() && !done; ++i) {
    done = job.take();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST(LabelJob, GivesItsLabelsOnceAndWakes) {
  std::atomic<int> woken = 0;
  LabelJob job([&] { ++woken; });
  EXPECT_FALSE(job.take());
  job.start("Fill", [](const LabelJob::Tell& tell) {
    tell(0.5);
    return Labels{1, 2, 3};
  });
  std::optional<LabelJob::Done> done;
  wait_for_end(job, done);
  ASSERT_TRUE(done);
  EXPECT_EQ(done->what, "Fill");
  EXPECT_EQ(done->labels, Labels({1, 2, 3}));
  EXPECT_EQ(job.fraction(), 0.5);
  EXPECT_EQ(woken, 1);
  EXPECT_FALSE(job.take());
  EXPECT_FALSE(job.is_running());
}

// What is stopped ends at its next word, and nothing comes of it; the next one runs as if nothing had been.
TEST(LabelJob, ACancelledOneGivesNothing) {
  LabelJob job([] {});
  std::atomic<bool> has_begun = false;
  job.start("Grow", [&](const LabelJob::Tell& tell) -> Labels {
    for (;;) {
      has_begun = true;
      tell(0.1);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  while (!has_begun) std::this_thread::yield();
  job.cancel();
  EXPECT_TRUE(job.is_cancelled());
  std::optional<LabelJob::Done> done;
  wait_for_end(job, done);
  EXPECT_FALSE(done);
  EXPECT_FALSE(job.is_running());
  job.start("Part", [](const LabelJob::Tell&) -> Labels { throw std::runtime_error("no stroke"); });
  wait_for_end(job, done);
  ASSERT_TRUE(done);
  EXPECT_EQ(done->failure, "no stroke");
  EXPECT_TRUE(done->labels.empty());
}

}  // namespace
}  // namespace arthronaut::paint
