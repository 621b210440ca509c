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
#include <string>
#include <utility>

#include "app/setup/frame_feed.h"

namespace arthronaut::setup {

enum class FeedPhase { Starting, Running, Ended, Failed };

template <typename Status>
struct RunStatus {
  FeedPhase phase = FeedPhase::Starting;
  std::string message;  // why the source failed, or why a live one gives no picture for now
  Status job;
  double looked_s = 0;        // when the newest picture was looked at, on the clock of steady_now_s()
  bool is_stills = false;     // single pictures: each stands as long as it takes
  bool awaits_still = false;  // ... and the next one is on its way
  // A look takes 50 to 200 ms; a picture that is much older is no longer what the camera sees.
  [[nodiscard]] bool is_of_now(double now_s) const {
    return phase == FeedPhase::Running && message.empty() && now_s - looked_s < 2.0;
  }
};

// Why there is no picture of now, while the source runs.
template <typename Status>
[[nodiscard]] std::string reason_of(const RunStatus<Status>& status) {
  return status.message.empty() ? "The source has stopped giving pictures" : status.message;
}

[[nodiscard]] inline double steady_now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <typename Job>
class LiveRun {
 public:
  using Status = RunStatus<typename Job::Status>;

  // make_job is called on the worker and may throw. on_news is called from the worker whenever status() has
  // changed; it must not call back.
  LiveRun(FeedSource source, std::function<std::unique_ptr<Job>()> make_job, std::function<void()> on_news)
      : source_(std::move(source)),
        worker_(
            worker::Backlog::Lossless,
            [source = source_, make_job = std::move(make_job)](Inbox& inbox) {
              Loop loop{inbox, make_job(), std::make_unique<FrameFeed>(source)};
              loop.status.is_stills = source.is_stills;
              while (!inbox.stops()) loop.step();
            },
            std::move(on_news)) {}

  [[nodiscard]] Status status() const {
    const auto latest = worker_.latest();
    Status status = latest == nullptr ? Status() : *latest;
    if (const std::string failure = worker_.failure(); !failure.empty()) {
      status.phase = FeedPhase::Failed;
      status.message = failure;
    }
    return status;
  }
  [[nodiscard]] const FeedSource& source() const { return source_; }

  void post(std::function<void(Job&)> request) { worker_.post({std::move(request), Wish::None}); }
  void next_still() { worker_.post({{}, Wish::NextStill}); }
  void release_source() { worker_.post({{}, Wish::ReleaseSource}); }

 private:
  enum class Wish { None, NextStill, ReleaseSource };
  struct Message {
    std::function<void(Job&)> request;
    Wish wish = Wish::None;
  };
  using Worker = worker::Worker<Message, Status>;
  using Inbox = typename Worker::Inbox;

  // The worker's side: one step takes what was posted, does what takes long, looks at one picture.
  struct Loop {
    Inbox& inbox;
    std::unique_ptr<Job> job;
    std::unique_ptr<FrameFeed> feed;  // null: released, or failed
    Status status = {};

    void step() {
      while (const auto message = inbox.poll()) take(*message);
      if (job->work()) publish();
      if (feed == nullptr || feed->has_ended()) {
        note_feed();
        return inbox.wait_until(Worker::Clock::now() + std::chrono::milliseconds(50));
      }
      try {
        if (const camera::FramePtr frame = feed->next()) {
          job->look(frame);
          if (job->wants_next_still()) feed->advance();
          status.looked_s = steady_now_s();
          publish();
        }
        note_feed();
      } catch (const std::exception& error) {
        feed.reset();
        status.phase = FeedPhase::Failed;
        status.message = error.what();
        publish();
      }
    }

    void take(const Message& message) {
      if (message.request) {
        message.request(*job);
        publish();
      }
      if (feed == nullptr) return;
      const bool is_asked = message.wish == Wish::NextStill;
      if (is_asked || (message.request && job->wants_next_still())) feed->advance();
      if (message.wish != Wish::ReleaseSource) return;
      feed.reset();
      status.phase = FeedPhase::Ended;
      publish();
    }

    void note_feed() {
      if (feed == nullptr) return;
      const FeedPhase phase = feed->has_ended()     ? FeedPhase::Ended
                              : feed->has_started() ? FeedPhase::Running
                                                    : FeedPhase::Starting;
      const bool awaits_still = feed->awaits_still();
      std::string trouble = feed->trouble();
      if (phase == status.phase && awaits_still == status.awaits_still && trouble == status.message) return;
      status.phase = phase;
      status.message = std::move(trouble);
      status.awaits_still = awaits_still;
      publish();
    }

    void publish() {
      status.job = job->status();
      inbox.publish(status);
    }
  };

  const FeedSource source_;
  Worker worker_;
};

}  // namespace arthronaut::setup
