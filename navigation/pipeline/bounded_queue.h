// The queue between two stages that each have a thread of their own. Lossless: a full queue makes the
// producer wait (push) or tells it so (try_push), or takes what must neither wait nor get lost
// (push_at_once). States: open -> closed, never back.
//
// Threads: any may call anything; meant for one producer and one consumer.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace arthronaut::pipeline {

template <typename Message>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

  // Waits while the queue is full. False when it is closed: the message is then dropped.
  bool push(Message message) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || messages_.size() < capacity_; });
    return push_locked(std::move(message));
  }
  // Never waits. False when the queue is full or closed.
  bool try_push(Message message) {
    const std::lock_guard lock(mutex_);
    return messages_.size() < capacity_ && push_locked(std::move(message));
  }
  // Never waits, and is taken by a full queue too: for the end of a run of messages, of which there are no
  // more than messages. False when it is closed.
  bool push_at_once(Message message) {
    const std::lock_guard lock(mutex_);
    return push_locked(std::move(message));
  }
  // Waits for a message; nullopt when the queue is closed and empty.
  std::optional<Message> pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || !messages_.empty(); });
    return pop_locked();
  }
  // The same, but nullopt too when nothing came until `deadline`.
  template <typename TimePoint>
  std::optional<Message> pop_until(const TimePoint& deadline) {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, deadline, [&] { return closed_ || !messages_.empty(); });
    return pop_locked();
  }
  // No more messages; what is in the queue can still be taken out.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  [[nodiscard]] bool is_closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }
  [[nodiscard]] bool is_drained() const {
    const std::lock_guard lock(mutex_);
    return closed_ && messages_.empty();
  }

 private:
  bool push_locked(Message message) {
    if (closed_) return false;
    messages_.push_back(std::move(message));
    changed_.notify_all();
    return true;
  }
  std::optional<Message> pop_locked() {
    if (messages_.empty()) return std::nullopt;
    std::optional<Message> message(std::move(messages_.front()));
    messages_.pop_front();
    changed_.notify_all();
    return message;
  }

  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Message> messages_;
  bool closed_ = false;
};

}  // namespace arthronaut::pipeline
