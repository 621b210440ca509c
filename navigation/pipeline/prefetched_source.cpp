#include "navigation/pipeline/prefetched_source.h"

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "planning/geometry/error.h"

namespace arthronaut::pipeline {

namespace {

// Four 1080p frames are 25 MB; more would not hide longer hiccups than a decoder has.
constexpr std::size_t kFramesAhead = 4;

using Clock = std::chrono::steady_clock;
// So long a live picture may wait for a consumer that was held up.
constexpr std::chrono::milliseconds kMostWait{50};

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g s", seconds);
  return text;
}

}  // namespace

Delivery delivery_of(const sources::SourceInfo& info) {
  return info.is_live() ? Delivery::CatchesUp : Delivery::Lossless;
}

// Shared by the thread and its owner, so that either may outlive the other. (Not a Worker, whose end waits
// for its thread.)
struct PrefetchedSource::State {
  using Lock = std::unique_lock<std::mutex>;

  // The thread's: opens what is not open yet, then fills `waiting` until it is told to stop.
  void run() {
    std::exception_ptr failure;
    try {
      if (opener) {
        std::unique_ptr<sources::FrameSource> opened = std::exchange(opener, nullptr)();
        const Lock lock(mutex);
        owned = std::move(opened);
        source = owned.get();
        info = source->info();
        delivery = delivery_of(info);
        is_open = true;
        // Nobody waits for it any longer: a source that takes itself up again must not go on for ever.
        if (stops && info.line) info.line->end();
        changed.notify_all();
      }
      while (camera::FramePtr frame = source->next()) {
        if (!put(std::move(frame))) break;
      }
    } catch (...) {
      failure = std::current_exception();  // handed over at next()
    }
    {
      const Lock lock(mutex);
      error = failure;
      has_ended = true;
      changed.notify_all();
    }
    owned.reset();  // here and last: closing a device may take its time as well
  }

  bool put(camera::FramePtr frame) {
    Lock lock(mutex);
    if (delivery == Delivery::CatchesUp &&
        (waiting.size() == kFramesAhead || (!waiting.empty() && is_too_slow)))
      leave_out_all_but(0);
    changed.wait(lock, [&] { return stops || waiting.size() < kFramesAhead; });
    if (stops) return false;
    waiting.push_back(std::move(frame), Clock::now());
    changed.notify_all();
    return true;
  }

  void leave_out_all_but(std::size_t newest) {
    while (waiting.size() > newest) (void)waiting.pop_front();
    is_too_slow = true;
  }

  // False when nothing was there in time.
  template <typename Ready>
  bool wait(Lock& lock, std::optional<double> seconds, const Ready& is_ready) {
    if (!seconds) {
      changed.wait(lock, is_ready);
      return true;
    }
    return changed.wait_for(lock, std::chrono::duration<double>(*seconds), is_ready);
  }

  NextFrame take(std::optional<double> seconds) {
    Lock lock(mutex);
    if (waiting.empty()) is_too_slow = false;
    (void)wait(lock, seconds, [&] { return has_ended || !waiting.empty(); });
    NextFrame next;
    if (delivery == Delivery::CatchesUp && waiting.size() > 1 && Clock::now() - waiting.since() > kMostWait)
      leave_out_all_but(1);
    if (!waiting.empty()) {
      next.frame = waiting.pop_front();
      changed.notify_all();
    } else if (has_ended) {
      if (error) std::rethrow_exception(error);
      next.has_ended = true;
    }
    return next;
  }

  std::mutex mutex;
  std::condition_variable changed;
  Opener opener;                                // the thread's
  std::unique_ptr<sources::FrameSource> owned;  // the thread's
  sources::FrameSource* source = nullptr;       // the thread's
  sources::SourceInfo info;                     // fixed once open
  Delivery delivery = Delivery::Lossless;       // the same
  std::optional<double> patience_s;             // of a source that was opened here
  // A ring: nothing is asked of the heap while frames go through.
  struct Waiting {
    std::array<camera::FramePtr, kFramesAhead> frames;
    std::array<Clock::time_point, kFramesAhead> came;
    std::size_t first = 0, count = 0;
    [[nodiscard]] bool empty() const { return count == 0; }
    [[nodiscard]] std::size_t size() const { return count; }
    void push_back(camera::FramePtr frame, Clock::time_point now) {
      const std::size_t at = (first + count++) % kFramesAhead;
      frames[at] = std::move(frame);
      came[at] = now;
    }
    [[nodiscard]] Clock::time_point since() const { return came[first]; }  // of the one that came first
    [[nodiscard]] camera::FramePtr pop_front() {
      camera::FramePtr frame = std::move(frames[first]);
      first = (first + 1) % kFramesAhead;
      --count;
      return frame;
    }
  } waiting;
  bool is_too_slow = false;  // the consumer of a live source: one was left out, and it has not waited since
  std::exception_ptr error;
  bool is_open = false, has_ended = false, stops = false;
  std::thread thread;  // its owner's
};

PrefetchedSource::PrefetchedSource(sources::FrameSource& source)
    : PrefetchedSource(source, delivery_of(source.info())) {}

PrefetchedSource::PrefetchedSource(sources::FrameSource& source, Delivery delivery)
    : state_(std::make_shared<State>()) {
  state_->source = &source;
  state_->info = source.info();
  state_->delivery = delivery;
  state_->is_open = true;
  state_->thread = std::thread([state = state_] { state->run(); });
}

PrefetchedSource::PrefetchedSource(Opener opener, double patience_s) : state_(std::make_shared<State>()) {
  State& s = *state_;
  s.opener = std::move(opener);
  s.patience_s = patience_s;
  s.thread = std::thread([state = state_] { state->run(); });
  State::Lock lock(s.mutex);
  const bool answered = s.wait(lock, patience_s, [&] { return s.is_open || s.has_ended; });
  if (s.is_open) return;
  s.stops = true;
  s.thread.detach();
  if (answered) std::rethrow_exception(s.error);
  throw DeviceError("the source does not answer: it was not open after " + seconds_text(patience_s));
}

PrefetchedSource::~PrefetchedSource() {
  {
    const State::Lock lock(state_->mutex);
    state_->stops = true;
    state_->changed.notify_all();
  }
  if (state_->info.line != nullptr) state_->info.line->end();
  if (state_->patience_s)
    state_->thread.detach();
  else
    state_->thread.join();
}

const sources::SourceInfo& PrefetchedSource::info() const { return state_->info; }

camera::FramePtr PrefetchedSource::next() {
  NextFrame next = state_->take(state_->patience_s);
  if (!next.frame && !next.has_ended) {
    throw DeviceError(state_->info.name + ": has given no picture for " + seconds_text(*state_->patience_s));
  }
  return std::move(next.frame);
}

NextFrame PrefetchedSource::next_within(double seconds) { return state_->take(seconds); }

std::optional<Eigen::Vector2i> PrefetchedSource::changed_to_px() const {
  return state_->info.line != nullptr ? state_->info.line->changed_to_px() : std::nullopt;
}
std::string PrefetchedSource::trouble() const {
  return state_->info.line != nullptr ? state_->info.line->trouble() : "";
}

std::string PrefetchedSource::remark() const {
  return state_->info.line != nullptr ? state_->info.line->remark() : "";
}

}  // namespace arthronaut::pipeline
