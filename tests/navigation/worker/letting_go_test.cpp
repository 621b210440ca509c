#include "navigation/worker/letting_go.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace arthronaut::worker {
namespace {

struct Slow {
  ~Slow() {
    until.wait();
    ++gone;
  }
  std::shared_future<void> until;
  std::atomic<int>& gone;
};

// The caller goes on while a destructor still waits; the end does not.
TEST(LettingGo, HoldsNobodyUp) {
  std::promise<void> may_go;
  const std::shared_future<void> until = may_go.get_future().share();
  std::atomic<int> gone = 0;
  {
    LettingGo letting_go;
    letting_go.take(std::unique_ptr<Slow>());
    letting_go.take(std::make_unique<Slow>(until, gone));
    letting_go.take(std::make_unique<Slow>(until, gone));
    EXPECT_EQ(gone, 0);
    may_go.set_value();
  }
  EXPECT_EQ(gone, 2);
}

}  // namespace
}  // namespace arthronaut::worker
