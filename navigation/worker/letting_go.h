// What takes long to destroy, since it waits for what it still has in the making, is destroyed beside the
// caller.
//
// Threads: every member is for the thread that made it.
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <utility>
#include <vector>

namespace arthronaut::worker {

class LettingGo {
 public:
  // Nobody else may use the thing any more. No effect for null.
  template <typename Thing>
  void take(std::unique_ptr<Thing> thing) {
    std::erase_if(going_, [](const std::future<void>& one) {
      return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    if (thing != nullptr)
      going_.push_back(std::async(std::launch::async, [gone = std::move(thing)]() mutable { gone.reset(); }));
  }
  // Waits until all that was taken is gone.
  ~LettingGo() = default;
  LettingGo() = default;
  LettingGo(const LettingGo&) = delete;
  LettingGo& operator=(const LettingGo&) = delete;

 private:
  std::vector<std::future<void>> going_;  // each waits for its own
};

}  // namespace arthronaut::worker
