#include "navigation/sources/background_end.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

namespace arthronaut::sources {
namespace {

// Stands for a reader: its destructor waits until it may end, as one that joins a thread does.
struct SlowReader {
  SlowReader(std::shared_future<void> may, std::promise<std::thread::id>& where)
      : may_end(std::move(may)), ended_on(where) {}
  ~SlowReader() {
    may_end.wait();
    ended_on.set_value(std::this_thread::get_id());
  }
  std::shared_future<void> may_end;
  std::promise<std::thread::id>& ended_on;
};

// end() returns while the reader is still ending, which happens on another thread.
TEST(BackgroundEnd, DoesNotWait) {
  std::promise<void> let_go;
  std::promise<std::thread::id> ended_on;
  std::future<std::thread::id> ended = ended_on.get_future();
  BackgroundEnd background;
  background.end(std::make_unique<SlowReader>(let_go.get_future().share(), ended_on));
  EXPECT_EQ(ended.wait_for(std::chrono::seconds(0)), std::future_status::timeout);
  let_go.set_value();
  EXPECT_NE(ended.get(), std::this_thread::get_id());
}

// Its own end waits for what it was given: nothing runs on behind the program's back.
TEST(BackgroundEnd, WaitsAtItsOwnEnd) {
  std::promise<void> let_go;
  let_go.set_value();
  std::promise<std::thread::id> ended_on;
  std::future<std::thread::id> ended = ended_on.get_future();
  {
    BackgroundEnd background;
    background.end(std::make_unique<SlowReader>(let_go.get_future().share(), ended_on));
  }
  EXPECT_EQ(ended.wait_for(std::chrono::seconds(0)), std::future_status::ready);
}

}  // namespace
}  // namespace arthronaut::sources
