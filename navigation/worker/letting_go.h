// What takes long to destroy, since it waits for what it still has in the making, is destroyed beside the
// caller.
//
// Threads: every member is for the thread that made it.
#pragma once

#include <memory>
#include <thread>
#include <utility>
#include <vector>

namespace arthronaut::worker {

class LettingGo {
 public:
  // Nobody else may use the thing any more. No effect for null.
  template <typename Thing>
  void take(std::unique_ptr<Thing> thing) {
    if (thing != nullptr) threads_.emplace_back([gone = std::move(thing)]() mutable { gone.reset(); });
  }
  // Until all that was taken is gone: before what it holds is asked for anew.
  void wait() { threads_.clear(); }
  // As wait().
  ~LettingGo() = default;
  LettingGo() = default;
  LettingGo(const LettingGo&) = delete;
  LettingGo& operator=(const LettingGo&) = delete;

 private:
  std::vector<std::jthread> threads_;
};

}  // namespace arthronaut::worker
