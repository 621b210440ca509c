#include "app/setup/frame_feed.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace arthronaut::setup {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kWait = std::chrono::milliseconds(50);
// A still is looked at again for the sake of "held still" and of what changed since; there is no hurry.
constexpr auto kStillAgain = std::chrono::milliseconds(250);

}  // namespace

struct FrameFeed::State {
  explicit State(FeedSource chosen) : source(std::move(chosen)) {}

  // The top of the feed's thread: whatever goes wrong is thrown again where the pictures are asked for.
  void run(const std::stop_token& stop) {
    try {
      const std::unique_ptr<sources::FrameSource> opened = source.open();
      {
        const std::lock_guard lock(mutex);
        started = true;
      }
      read(*opened, stop);
    } catch (...) {
      const std::lock_guard lock(mutex);
      error = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    ended = true;
    changed.notify_all();
  }

  void read(sources::FrameSource& opened, const std::stop_token& stop) {
    const bool is_paced = !opened.info().is_live() && !source.is_stills;
    Clock::time_point start = Clock::now();
    std::int64_t first_ns = -1;
    while (!stop.stop_requested()) {
      camera::FramePtr frame = opened.next();
      if (frame == nullptr) return;
      std::unique_lock lock(mutex);
      if (is_paced) {
        if (first_ns < 0) {
          first_ns = frame->timestamp_ns;
          start = Clock::now();
        }
        const auto due = start + std::chrono::nanoseconds(frame->timestamp_ns - first_ns);
        changed.wait_until(lock, due, [&] { return stop.stop_requested(); });
      }
      newest = std::move(frame);
      is_fresh = true;
      changed.notify_all();
      if (source.is_stills) {
        is_standing = true;
        changed.wait(lock, [&] { return stop.stop_requested() || !is_standing; });
      } else if (!source.newest_wins) {
        changed.wait(lock, [&] { return stop.stop_requested() || !is_fresh; });
      }
    }
  }

  const FeedSource source;
  mutable std::mutex mutex;
  std::condition_variable changed;
  camera::FramePtr newest;
  bool is_fresh = false, is_standing = false, started = false, ended = false;
  Clock::time_point given_at;
  std::exception_ptr error;
  std::jthread thread;
};

FrameFeed::FrameFeed(FeedSource source) : state_(std::make_unique<State>(std::move(source))) {
  state_->thread = std::jthread([s = state_.get()](const std::stop_token& stop) { s->run(stop); });
}

FrameFeed::~FrameFeed() {
  state_->thread.request_stop();
  {
    const std::lock_guard lock(state_->mutex);  // no wait may begin between its test and this call
    state_->changed.notify_all();
  }
  state_->thread.join();
}

camera::FramePtr FrameFeed::next() {
  State& s = *state_;
  std::unique_lock lock(s.mutex);
  s.changed.wait_for(lock, kWait, [&] { return s.is_fresh || s.error != nullptr; });
  const bool again = s.is_standing && Clock::now() - s.given_at > kStillAgain;
  if (s.is_fresh || again) {
    s.is_fresh = false;
    s.given_at = Clock::now();
    s.changed.notify_all();
    return s.newest;
  }
  if (s.error != nullptr) std::rethrow_exception(std::exchange(s.error, nullptr));
  return nullptr;
}

void FrameFeed::advance() {
  const std::lock_guard lock(state_->mutex);
  if (state_->is_fresh) return;  // nobody has looked at the one that came
  state_->is_standing = false;
  state_->changed.notify_all();
}

bool FrameFeed::has_started() const {
  const std::lock_guard lock(state_->mutex);
  return state_->started;
}

bool FrameFeed::awaits_still() const {
  const std::lock_guard lock(state_->mutex);
  return state_->source.is_stills && !state_->is_standing && !state_->ended;
}

bool FrameFeed::has_ended() const {
  const std::lock_guard lock(state_->mutex);
  return state_->ended && !state_->is_fresh;
}

}  // namespace arthronaut::setup
