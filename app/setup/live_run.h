// A job on the pictures of a source, in a thread of its own. The window reads status() and posts requests.
// The destructor waits for the step that is being done: sources::BackgroundEnd takes that off the screen's
// thread.
//
// A Job is thread-free, so that tests call it directly:
//   struct Status;                        // cheap to copy
//   void look(const camera::FramePtr&);   // one picture
//   bool work();                          // does what takes long and was asked for; false: there was nothing
//   bool wants_next_still() const;        // of single pictures: this one is done with
//   Status status() const;
//
// A source that fails ends the pictures, not the job: what was collected can still be used.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/setup/frame_feed.h"

namespace arthronaut::setup {

enum class FeedPhase { Starting, Running, Ended, Failed };

template <typename Status>
struct RunStatus {
  FeedPhase phase = FeedPhase::Starting;
  std::string message;  // why the source failed
  Status job;
  double looked_s = 0;        // when the newest picture was looked at, on the clock of steady_now_s()
  bool is_stills = false;     // single pictures: each stands as long as it takes
  bool awaits_still = false;  // ... and the next one is on its way
  // A look takes 50 to 200 ms; a picture that is much older is no longer what the camera sees.
  [[nodiscard]] bool is_of_now(double now_s) const {
    return phase == FeedPhase::Running && now_s - looked_s < 2.0;
  }
};

[[nodiscard]] inline double steady_now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <typename Job>
class LiveRun {
 public:
  using Status = RunStatus<typename Job::Status>;

  // make_job is called on the worker and may throw. on_news is called from the worker whenever status() has
  // changed.
  LiveRun(FeedSource source, std::function<std::unique_ptr<Job>()> make_job, std::function<void()> on_news)
      : source_(std::move(source)), make_job_(std::move(make_job)), on_news_(std::move(on_news)) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  [[nodiscard]] Status status() const {
    const std::lock_guard lock(mutex_);
    return status_;
  }
  [[nodiscard]] const FeedSource& source() const { return source_; }

  void post(std::function<void(Job&)> request) {
    const std::lock_guard lock(mutex_);
    requests_.push_back(std::move(request));
  }
  void next_still() {
    const std::lock_guard lock(mutex_);
    wants_next_still_ = true;
  }
  void release_source() {
    const std::lock_guard lock(mutex_);
    releases_source_ = true;
  }

 private:
  // The top of the worker: whatever goes wrong becomes a state.
  void run(const std::stop_token& stop) {
    try {
      const std::unique_ptr<Job> job = make_job_();
      auto feed = std::make_unique<FrameFeed>(source_);
      while (!stop.stop_requested()) step(*job, feed);
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }

  void step(Job& job, std::unique_ptr<FrameFeed>& feed) {
    bool has_news = run_requests(job, feed);
    if (has_news) publish(job);
    if (job.work()) publish(job);
    if (feed == nullptr) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      return;
    }
    try {
      const camera::FramePtr frame = feed->next();
      if (frame != nullptr) {
        job.look(frame);
        if (job.wants_next_still()) feed->advance();
        note_look();
        publish(job);
      }
      note_feed(*feed);
    } catch (const std::exception& error) {
      feed.reset();
      fail(error.what());
    }
  }

  bool run_requests(Job& job, std::unique_ptr<FrameFeed>& feed) {
    std::vector<std::function<void(Job&)>> requests;
    bool releases = false, next = false;
    {
      const std::lock_guard lock(mutex_);
      std::swap(requests, requests_);
      releases = std::exchange(releases_source_, false);
      next = std::exchange(wants_next_still_, false);
    }
    for (const auto& request : requests) request(job);
    if (feed != nullptr && (next || (!requests.empty() && job.wants_next_still()))) feed->advance();
    if (releases && feed != nullptr) {
      feed.reset();
      set_phase(FeedPhase::Ended);
    }
    return !requests.empty();
  }

  void publish(const Job& job) {
    {
      const std::lock_guard lock(mutex_);
      status_.job = job.status();
    }
    on_news_();
  }
  void note_look() {
    const std::lock_guard lock(mutex_);
    status_.looked_s = steady_now_s();
  }
  void note_feed(const FrameFeed& feed) {
    set_phase(feed.has_ended()     ? FeedPhase::Ended
              : feed.has_started() ? FeedPhase::Running
                                   : FeedPhase::Starting);
    const std::lock_guard lock(mutex_);
    status_.is_stills = source_.is_stills;
    status_.awaits_still = feed.awaits_still();
  }
  void set_phase(FeedPhase phase) {
    {
      const std::lock_guard lock(mutex_);
      if (status_.phase == phase || status_.phase == FeedPhase::Failed) return;
      status_.phase = phase;
    }
    on_news_();
  }
  void fail(const char* message) {
    {
      const std::lock_guard lock(mutex_);
      status_.phase = FeedPhase::Failed;
      status_.message = message;
    }
    on_news_();
  }

  const FeedSource source_;
  const std::function<std::unique_ptr<Job>()> make_job_;
  const std::function<void()> on_news_;
  mutable std::mutex mutex_;
  Status status_;
  std::vector<std::function<void(Job&)>> requests_;
  bool wants_next_still_ = false, releases_source_ = false;
  std::jthread thread_;
};

}  // namespace arthronaut::setup
