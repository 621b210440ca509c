// What those who wait for the pictures of a live source are told of it, and how they tell it to end: the
// source may be busy connecting on a thread of its own, and never answers a question itself.
//
// Threads: any.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace arthronaut::sources {

class SourceLine {
 public:
  // The source: why no picture comes, in words for the screen; empty: they come. changed_to_px: those that
  // it gets are of that size, and no waiting makes them fit.
  void say(std::string trouble, const std::optional<Eigen::Vector2i>& changed_to_px = std::nullopt) {
    const std::lock_guard lock(mutex_);
    trouble_ = std::move(trouble);
    changed_to_px_ = changed_to_px;
    has_trouble_ = !trouble_.empty();
  }
  void pictures_come() {
    if (has_trouble_) say("");
  }
  // The source: what is wrong with the pictures that come; empty: nothing.
  void say_of_pictures(std::string remark) {
    const std::lock_guard lock(mutex_);
    remark_ = std::move(remark);
    has_remark_ = !remark_.empty();
  }
  // The source: waits, but not when it is to end.
  void rest(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    ending_.wait_for(lock, time, [this] { return ends_.load(); });
  }
  [[nodiscard]] bool ends() const { return ends_; }

  // Whoever waits.
  [[nodiscard]] std::string trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
  }
  [[nodiscard]] std::optional<Eigen::Vector2i> changed_to_px() const {
    const std::lock_guard lock(mutex_);
    return changed_to_px_;
  }
  // Without a lock while there is none: asked for with every picture.
  [[nodiscard]] std::string remark() const {
    if (!has_remark_) return {};
    const std::lock_guard lock(mutex_);
    return remark_;
  }
  void end() {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    ending_.notify_all();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable ending_;
  std::string trouble_, remark_;
  std::optional<Eigen::Vector2i> changed_to_px_;
  std::atomic<bool> has_trouble_ = false, has_remark_ = false, ends_ = false;
};

}  // namespace arthronaut::sources
