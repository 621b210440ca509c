// Watches from beside whether the screen is still drawn while an operation runs, and writes it down when it
// is not: the screen itself can't say so while it stands still.
//
// Threads: frame_drawn() on the draw thread; `tell` is called on a thread of the watch's own.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

#include "navigation/worker/worker.h"

namespace arthronaut::window {

class DrawWatch {
 public:
  using Tell = std::function<void(const std::string& what)>;
  // tell: called once when no frame came for longer than `limit` while it mattered, and once when one came
  // again.
  DrawWatch(Tell tell, std::chrono::milliseconds limit);

  // matters: an operation runs; the time until the next frame is watched.
  void frame_drawn(bool matters);

 private:
  struct Nothing {};
  using Watcher = worker::Worker<Nothing, Nothing>;
  void watch(Watcher::Inbox& inbox);

  Tell tell_;
  std::chrono::milliseconds limit_;
  std::atomic<Watcher::Clock::rep> last_{0};  // when the last frame was drawn
  std::atomic<bool> matters_{false};
  Watcher watcher_;  // last: ends before the rest goes
};

}  // namespace arthronaut::window
