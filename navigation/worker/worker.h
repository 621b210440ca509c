// The one way this program runs something beside the screen: a thread with a body, an inbox and one published
// value.
//
// The body is a function that takes messages out of its inbox and publishes what comes of them. Whoever made
// the worker posts messages and reads the newest published value; neither ever waits for the other. What the
// body computes should be a class without threads, so that tests and the command line run it without a
// worker.
//
//   Worker<Request, Answer> worker(Backlog::Lossless, [](auto& inbox) {
//     while (const auto request = inbox.next()) inbox.publish(answer_of(*request));
//   });
//
// States: running -> ended (the body returned, or threw: then failure() says why). Stopping is asked for and
// never forced: next() and wait_until() return at once, and a body that computes for long asks stops().
// Threads: every member of Worker may be called from any thread; Inbox belongs to the body's thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "planning/log/log.h"

namespace arthronaut::worker {

// What waits when the body is slower than the messages come: all of it, or the newest message alone.
enum class Backlog { Lossless, NewestWins };

template <typename Message, typename Published>
class Worker {
  struct Shared {
    mutable std::mutex mutex;
    std::condition_variable_any wake, idle, news;
    std::deque<Message> waiting;
    std::shared_ptr<const Published> published;
    std::string failure;
    std::exception_ptr error;
    bool is_idle = false, has_ended = false;
    Backlog backlog = Backlog::Lossless;
    std::function<void()> on_news;
  };

 public:
  using Clock = std::chrono::steady_clock;

  // The worker as its body sees it.
  class Inbox {
   public:
    Inbox(Shared& shared, std::stop_token stop) : shared_(shared), stop_(std::move(stop)) {}
    [[nodiscard]] bool stops() const { return stop_.stop_requested(); }
    // Waits for a message; nullopt when the worker is to stop, whatever still waits.
    [[nodiscard]] std::optional<Message> next() {
      std::unique_lock lock(shared_.mutex);
      if (shared_.waiting.empty()) rest();
      const bool has_one = shared_.wake.wait(lock, stop_, [&] { return !shared_.waiting.empty(); });
      if (!has_one || stops()) return std::nullopt;
      return take_front();
    }
    // A message when one waits; never waits itself.
    [[nodiscard]] std::optional<Message> poll() {
      const std::lock_guard lock(shared_.mutex);
      if (shared_.waiting.empty()) return std::nullopt;
      return take_front();
    }
    // Something newer waits: work that goes on for long may want to end early.
    [[nodiscard]] bool has_message() const {
      const std::lock_guard lock(shared_.mutex);
      return !shared_.waiting.empty();
    }
    // Until the time has come, a message waits or the worker is to stop.
    void wait_until(Clock::time_point time) {
      std::unique_lock lock(shared_.mutex);
      if (shared_.waiting.empty()) rest();
      shared_.wake.wait_until(lock, stop_, time, [&] { return !shared_.waiting.empty(); });
    }
    // Until the time has come or the worker is to stop; messages wait.
    void sleep_until(Clock::time_point time) {
      std::unique_lock lock(shared_.mutex);
      shared_.wake.wait_until(lock, stop_, time, [] { return false; });
    }
    // As Worker::post(), for whoever the body sets to work; from any thread, while the body runs.
    void post(Message message) { Worker::post(shared_, std::move(message)); }
    void publish(std::shared_ptr<const Published> value) {
      {
        const std::lock_guard lock(shared_.mutex);
        shared_.published = std::move(value);
      }
      shared_.news.notify_all();
      if (shared_.on_news) shared_.on_news();
    }
    void publish(Published value) { publish(std::make_shared<const Published>(std::move(value))); }

   private:
    Message take_front() {
      Message message = std::move(shared_.waiting.front());
      shared_.waiting.pop_front();
      shared_.is_idle = false;
      return message;
    }
    void rest() {
      shared_.is_idle = true;
      shared_.idle.notify_all();
    }
    Shared& shared_;
    std::stop_token stop_;
  };
  using Body = std::function<void(Inbox&)>;

  // on_news is called from the worker's thread after each publish() and at the end; it must not call back
  // into the worker.
  Worker(Backlog backlog, Body body, std::function<void()> on_news = {})
      : shared_(std::make_unique<Shared>()) {
    shared_->backlog = backlog;
    shared_->on_news = std::move(on_news);
    thread_ = std::jthread([shared = shared_.get(), body = std::move(body)](const std::stop_token& stop) {
      run(*shared, body, stop);
    });
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  // Asks it to stop and waits for the piece of work in hand.
  ~Worker() = default;

  // Dropped when the worker has ended.
  void post(Message message) { post(*shared_, std::move(message)); }
  // The newest published value, whole; null before the first.
  [[nodiscard]] std::shared_ptr<const Published> latest() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->published;
  }
  // The same, but waits until it is another one than `known`, the worker has ended, or the time has come.
  [[nodiscard]] std::shared_ptr<const Published> wait_for_other_than(
      const std::shared_ptr<const Published>& known, Clock::time_point until) const {
    std::unique_lock lock(shared_->mutex);
    shared_->news.wait_until(lock, until, [&] { return shared_->published != known || shared_->has_ended; });
    return shared_->published;
  }
  [[nodiscard]] bool has_ended() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->has_ended;
  }
  // Why the body threw; empty else.
  [[nodiscard]] std::string failure() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->failure;
  }
  // What it threw, to be thrown again where somebody can answer for it; null else.
  [[nodiscard]] std::exception_ptr error() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->error;
  }
  void request_stop() { thread_.request_stop(); }
  // It was asked for and is not yet done.
  [[nodiscard]] bool is_stopping() const { return thread_.get_stop_token().stop_requested() && !has_ended(); }
  // Waits until all that was posted so far is worked in, or the worker has ended; for tests and for the end.
  void finish() const {
    std::unique_lock lock(shared_->mutex);
    shared_->idle.wait(lock,
                       [&] { return (shared_->is_idle && shared_->waiting.empty()) || shared_->has_ended; });
  }

 private:
  static void post(Shared& shared, Message message) {
    {
      const std::lock_guard lock(shared.mutex);
      if (shared.has_ended) return;
      if (shared.backlog == Backlog::NewestWins) shared.waiting.clear();
      shared.waiting.push_back(std::move(message));
      shared.is_idle = false;
    }
    shared.wake.notify_all();
  }

  // The top of the thread: what is thrown here becomes a state.
  static void run(Shared& shared, const Body& body, const std::stop_token& stop) {
    std::string failure;
    std::exception_ptr thrown;
    try {
      Inbox inbox(shared, stop);
      body(inbox);
    } catch (const std::exception& error) {
      failure = error.what();
      log::error("a worker has ended: " + failure);
      thrown = std::current_exception();
    }
    {
      const std::lock_guard lock(shared.mutex);
      shared.failure = std::move(failure);
      shared.error = std::move(thrown);
      shared.has_ended = true;
      shared.idle.notify_all();
      shared.news.notify_all();
    }
    if (shared.on_news) shared.on_news();
  }

  std::unique_ptr<Shared> shared_;
  std::jthread thread_;  // last: stops and joins before the rest goes
};

}  // namespace arthronaut::worker
