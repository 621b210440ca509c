#include "navigation/theatre/live_operation.h"

#include <chrono>
#include <variant>

#include "navigation/worker/worker.h"

namespace arthronaut::theatre {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_of(Clock::time_point time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

// A recorded or simulated source is shown at its own pace: faster sources wait, slower ones run in slow
// motion rather than leave frames out, since every frame may carry a touched point.
class Pace {
 public:
  // When the frame with this timestamp is due.
  Clock::time_point due(std::int64_t timestamp_ns) {
    const Clock::time_point now = Clock::now();
    const Clock::time_point due = start_ + std::chrono::nanoseconds(timestamp_ns - first_ns_);
    if (started_ && due + std::chrono::milliseconds(100) >= now) return due;
    started_ = true;
    start_ = now;
    first_ns_ = timestamp_ns;
    return now;
  }

 private:
  bool started_ = false;
  Clock::time_point start_;
  std::int64_t first_ns_ = 0;
};

class Rate {
 public:
  // Counts a frame; the rate of the last second or so.
  double count() {
    ++frames_;
    const double since_s = std::chrono::duration<double>(Clock::now() - from_).count();
    if (since_s > 1) {
      rate_ = frames_ / since_s;
      frames_ = 0;
      from_ = Clock::now();
    }
    return rate_;
  }

 private:
  int frames_ = 0;
  double rate_ = 0;
  Clock::time_point from_ = Clock::now();
};

struct EndSource {};
struct KeepVideo {
  bool on;
};
struct FollowRegistration {};
using Request = std::variant<TheatreSource, EndSource, KeepVideo, FollowRegistration, operation::Command>;
using LiveWorker = worker::Worker<Request, LiveState>;

// What the thread does.
class Loop {
 public:
  Loop(LiveWorker::Inbox& inbox, const LiveOptions& options)
      : inbox_(inbox),
        options_(options),
        run_(options.operation,
             registration_beside(options.bone, operation::work_options(options.operation),
                                 [&inbox] { inbox.post(FollowRegistration{}); }),
             options.make_session_folder, looks_beside()) {}

  void run() {
    publish();
    while (!inbox_.stops()) {
      while (auto request = inbox_.poll()) carry_out(*request);
      if (run_.has_source()) {
        take_frame();
      } else if (auto request = inbox_.next()) {
        carry_out(*request);
      }
    }
  }

 private:
  void carry_out(const Request& request) {
    std::visit([this](const auto& r) { take(r); }, request);
  }
  void take(const TheatreSource& source) {
    live_ = {};
    live_.phase = LiveState::Phase::Starting;
    pace_ = {};
    rate_ = {};
    publish();
    try {  // a source that cannot be opened is a state of the screen
      run_.start(source);
      live_.phase = LiveState::Phase::Running;
    } catch (const std::exception& error) {
      live_.phase = LiveState::Phase::Failed;
      live_.message = error.what();
    }
    kind_ = source.setup.kind;
    publish();
  }
  void take(const EndSource&) {
    if (!run_.has_source()) return;
    end(LiveState::Phase::Ended);
  }
  // Whatever ending it throws: the screen knows that it has ended.
  void end(LiveState::Phase phase, const std::string& message = "") {
    live_.phase = phase;
    live_.message = message;
    try {
      run_.end_source();
    } catch (const std::exception& error) {
      live_.phase = LiveState::Phase::Failed;
      live_.message = error.what();
    }
    publish();
  }
  void take(const KeepVideo& keep) {
    run_.keep_video(keep.on);
    publish();
  }
  void take(const FollowRegistration&) {
    if (run_.follow_registration()) publish();
  }
  void take(const operation::Command& command) {
    run_.apply(command);
    publish();
  }

  void take_frame() {
    OperationRun::Step step;
    try {  // a source that fails ends, and what was made stays
      step = run_.step();
    } catch (const std::exception& error) {
      return end(LiveState::Phase::Failed, error.what());
    }
    if (step.has_ended) return end(LiveState::Phase::Ended);
    if (step.picture == nullptr) return;  // the screen sees for itself how old the last one is
    const operation::OperationStatePtr state = run_.state_of_frame();
    if (options_.decorate) live_.decoration = options_.decorate(*state);
    const bool is_live = kind_ == sources::SourceKind::Live;
    if (!is_live) inbox_.sleep_until(pace_.due(step.picture->timestamp_ns));
    live_.picture = step.picture;
    const bool is_dated = is_live && step.picture->captured_ns > 0;
    live_.captured_s =
        is_dated ? static_cast<double>(step.picture->captured_ns) * 1e-9 : seconds_of(Clock::now());
    live_.stale_after_s = is_live ? options_.live_stale_after_s : options_.other_stale_after_s;
    live_.frames_per_second = rate_.count();
    publish(state);
  }

  void publish() { publish(run_.state()); }
  void publish(operation::OperationStatePtr state) {
    live_.operation = std::move(state);
    live_.session_folder = run_.session_folder();
    live_.keeps_video = run_.keeps_video();
    live_.record_trouble = run_.record_trouble();
    inbox_.publish(live_);
  }

  LiveWorker::Inbox& inbox_;
  const LiveOptions& options_;
  OperationRun run_;
  LiveState live_;
  Pace pace_;
  Rate rate_;
  sources::SourceKind kind_ = sources::SourceKind::Simulation;
};

}  // namespace

struct LiveOperation::Thread {
  Thread(LiveOptions with, std::function<void()> on_news)
      : options(std::move(with)),
        worker(
            worker::Backlog::Lossless, [this](LiveWorker::Inbox& inbox) { Loop(inbox, options).run(); },
            std::move(on_news)) {
    initial.operation = std::make_shared<const operation::OperationState>();
  }
  const LiveOptions options;
  LiveState initial;
  LiveWorker worker;
};

LiveOperation::LiveOperation(LiveOptions options, std::function<void()> on_news)
    : thread_(std::make_unique<Thread>(std::move(options), std::move(on_news))) {}
LiveOperation::~LiveOperation() = default;

void LiveOperation::start(TheatreSource source) { thread_->worker.post(std::move(source)); }
void LiveOperation::end_source() { thread_->worker.post(EndSource{}); }
void LiveOperation::apply(operation::Command command) { thread_->worker.post(std::move(command)); }
void LiveOperation::keep_video(bool on) { thread_->worker.post(KeepVideo{on}); }
void LiveOperation::request_stop() { thread_->worker.request_stop(); }

LiveStatePtr LiveOperation::latest() const {
  LiveStatePtr latest = thread_->worker.latest();
  return latest != nullptr ? latest : std::make_shared<const LiveState>(thread_->initial);
}

const operation::OperationSetup& LiveOperation::setup() const { return thread_->options.operation; }
std::string LiveOperation::failure() const { return thread_->worker.failure(); }
void LiveOperation::finish() const { thread_->worker.finish(); }
double LiveOperation::now_s() { return seconds_of(Clock::now()); }

}  // namespace arthronaut::theatre
