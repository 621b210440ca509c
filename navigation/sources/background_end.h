// Ends what joins a thread of its own without making the caller wait: readers of sources, whose last picture
// is still being made.
#pragma once

#include <chrono>
#include <future>
#include <utility>
#include <vector>

namespace arthronaut::sources {

// One thread calls end(); what is handed over is destroyed on others. The destructor waits for all of it.
class BackgroundEnd {
 public:
  template <typename Owned>
  void end(Owned owned) {
    std::erase_if(ending_, [](const std::future<void>& ending) {
      return ending.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    ending_.push_back(std::async(std::launch::async, [ended = std::move(owned)]() mutable {
      [[maybe_unused]] const Owned gone = std::move(ended);  // here, not where the future is kept
    }));
  }

 private:
  std::vector<std::future<void>> ending_;
};

}  // namespace arthronaut::sources
