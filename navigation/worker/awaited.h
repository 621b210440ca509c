// One result that is waited for: a piece of work that runs beside the screen once and ends by itself, as
// opening a case. What goes on beside it for long, or again and again, is a Worker.
//
//   Awaited<Volume> loading;
//   loading.start([folder] { return read(folder); }, wake);
//   ...
//   if (loading.is_ready()) show(loading.take());  // once a frame
//
// Nothing stops the work but the work itself.
// Threads: every member is for the thread that made it; the work and on_end run on one of their own.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <thread>
#include <utility>

namespace arthronaut::worker {

template <typename Result>
class Awaited {
 public:
  Awaited() = default;
  Awaited(const Awaited&) = delete;
  Awaited& operator=(const Awaited&) = delete;
  ~Awaited() = default;  // as drop()

  // on_end is called when is_ready() holds, however the work ended. What was started before is dropped.
  template <typename Work>
  void start(Work work, std::function<void()> on_end) {
    drop();
    std::packaged_task<Result()> task(std::move(work));
    result_ = task.get_future();
    thread_ = std::jthread([task = std::move(task), on_end = std::move(on_end)]() mutable {
      task();
      on_end();
    });
  }
  // Running, or ready and not taken.
  [[nodiscard]] bool is_busy() const { return result_.valid(); }
  [[nodiscard]] bool is_ready() const {
    return is_busy() && result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }
  // What the work returned, once; throws what it threw. Waits where it is not ready. Precondition: is_busy().
  Result take() { return result_.get(); }
  // Waits for the end of the work and of on_end, and takes nothing.
  void drop() {
    if (thread_.joinable()) thread_.join();
    result_ = {};
  }

 private:
  std::future<Result> result_;
  std::jthread thread_;  // last: joins before the result goes
};

}  // namespace arthronaut::worker
