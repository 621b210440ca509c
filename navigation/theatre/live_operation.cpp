#include "navigation/theatre/live_operation.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>

#include "navigation/sources/capture_time.h"
#include "navigation/worker/pace.h"
#include "navigation/worker/recycler.h"
#include "navigation/worker/worker.h"

namespace arthronaut::theatre {

namespace {

using Clock = std::chrono::steady_clock;

// Recordings and simulations come as the machine can make them.
constexpr double kOtherStaleAfter_s = 2.0;

double seconds_of(Clock::time_point time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

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

// What of the latency the screen alone knows.
class DisplayLatency {
 public:
  void shown(const LiveState& live, double drawn_s, double now_s) {
    const std::lock_guard lock(mutex_);
    const double age_s = drawn_s - live.captured_s;
    if (live.published_s == last_published_s_) last_age_s_ = age_s;
    if (live.published_s <= last_published_s_) return;
    if (last_published_s_ > 0) outlived_s_ = std::max(outlived_s_.value_or(0), last_age_s_);
    last_published_s_ = live.published_s;
    last_age_s_ = age_s;
    meter_.add(Stage::Display, 1000 * (now_s - live.published_s));
    meter_.add(Stage::ToScreen, 1000 * (now_s - live.captured_s));
  }
  void add_to(LatencyReport& report) const {
    const std::lock_guard lock(mutex_);
    const LatencyReport own = meter_.report();
    for (const Stage stage : {Stage::Display, Stage::ToScreen})
      report[static_cast<std::size_t>(stage)] = of(own, stage);
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    meter_.clear();
    last_published_s_ = 0;
    outlived_s_.reset();
  }
  // How old a picture was when it was drawn last before the next one took its place: the oldest since this
  // was asked last; empty: none was replaced.
  [[nodiscard]] std::optional<double> take_outlived_s() {
    const std::lock_guard lock(mutex_);
    return std::exchange(outlived_s_, std::nullopt);
  }

 private:
  mutable std::mutex mutex_;
  LatencyMeter meter_;
  double last_published_s_ = 0, last_age_s_ = 0;
  std::optional<double> outlived_s_;
};

struct EndSource {};
struct VideoRequest {
  bool on;
};
struct LeftRecord {
  std::filesystem::path session_folder;
};
struct FollowRegistration {};
using Request = std::variant<TheatreSource, EndSource, VideoRequest, recording::PicturesAs, LeftRecord,
                             FollowRegistration, operation::Command>;
using LiveWorker = worker::Worker<Request, LiveState>;

// What the thread does.
class Loop {
 public:
  Loop(LiveWorker::Inbox& inbox, const LiveOptions& options, DisplayLatency& display)
      : inbox_(inbox),
        options_(options),
        display_(display),
        run_(options.operation,
             registration_beside(options.bone, operation::work_options(options.operation),
                                 [&inbox] { inbox.post(FollowRegistration{}); }),
             options.make_session_folder, looks_beside()) {
    run_.late_after(options.live_stale_after_s);
  }

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
    // What the surgeon said before the case was closed belongs into its record.
    while (auto request = inbox_.poll())
      if (const auto* command = std::get_if<operation::Command>(&*request)) take(*command);
  }

 private:
  void carry_out(const Request& request) {
    std::visit([this](const auto& r) { take(r); }, request);
  }
  void take(const TheatreSource& source) {
    live_ = {};
    live_.refusal = run_.refusal();
    live_.phase = LiveState::Phase::Starting;
    pace_ = {};
    rate_ = {};
    display_.clear();
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
  void take(const VideoRequest& keep) {
    run_.keep_video(keep.on);
    publish();
  }
  void take(const recording::PicturesAs& as) { run_.keep_pictures_as(as); }
  void take(const LeftRecord& left) { run_.goes_on_after(left.session_folder); }
  void take(const FollowRegistration&) {
    if (run_.follow_registration()) publish();
  }
  void take(const operation::Command& command) {
    run_.apply(command);
    publish();
  }

  void take_frame() {
    if (const auto outlived_s = display_.take_outlived_s())
      run_.shown_until(1000 * *outlived_s, sources::steady_now_ns());
    OperationRun::Step step;
    try {  // a source that fails ends, and what was made stays
      step = run_.step();
    } catch (const std::exception& error) {
      return end(LiveState::Phase::Failed, error.what());
    }
    if (step.has_ended) return end(LiveState::Phase::Ended);
    live_.trouble = run_.watch().trouble();
    live_.trouble_words = run_.watch().words();
    live_.changed_to_px = run_.watch().changed_to_px();
    // How old the last one is the screen sees for itself; why none comes is news.
    if (step.picture == nullptr) return live_.trouble != SourceTrouble::None ? publish() : void();
    const Clock::time_point ready = Clock::now();
    const operation::OperationStatePtr state = run_.state_of_frame();
    if (options_.decorate) live_.decoration = options_.decorate(*state);
    const bool is_live = kind_ == sources::SourceKind::Live;
    if (!is_live) await(pace_.due(step.picture->timestamp_ns));
    live_.picture = step.picture;
    const bool is_dated = is_live && step.picture->captured_ns > 0;
    live_.captured_s =
        is_dated ? static_cast<double>(step.picture->captured_ns) * 1e-9 : seconds_of(Clock::now());
    const double content_s = run_.content_s(live_.captured_s);
    // What is shown is as old as the oldest thing in it.
    live_.captured_s = std::min(live_.captured_s, run_.oldest_pose_s(live_.captured_s));
    live_.shown_for_s = std::max(0.0, live_.captured_s - content_s);
    live_.stale_after_s = is_live ? options_.live_stale_after_s : kOtherStaleAfter_s;
    live_.frames_per_second = rate_.count();
    live_.published_s = seconds_of(Clock::now());
    if (is_live) refresh_latency();
    publish(state);
    if (is_live)
      run_.latency().add(Stage::Publish,
                         std::chrono::duration<double, std::milli>(Clock::now() - ready).count());
  }

  // What is pressed during a long wait is not to wait as long.
  void await(Clock::time_point due) {
    if (due - Clock::now() > std::chrono::milliseconds(100))
      inbox_.wait_until(due);
    else
      inbox_.sleep_until(due);
  }

  // Once a second is as often as anybody reads it.
  void refresh_latency() {
    if (live_.published_s - latency_at_s_ < 1) return;
    latency_at_s_ = live_.published_s;
    live_.latency = run_.latency().report();
    display_.add_to(live_.latency);
  }

  void publish() { publish(run_.state()); }
  void publish(operation::OperationStatePtr state) {
    live_.operation = std::move(state);
    live_.session_folder = run_.session_folder();
    live_.keeps_video = run_.keeps_video();
    live_.record_trouble = run_.record_trouble();
    live_.video_trouble = run_.video_trouble();
    if (run_.refusal().count != live_.refusal.count) live_.refused_s = seconds_of(Clock::now());
    live_.refusal = run_.refusal();
    live_.tracker_trouble = run_.tracker_trouble();
    const auto published = published_.take();
    *published = live_;
    inbox_.publish(std::shared_ptr<const LiveState>(published));
    if (options_.tell) options_.tell(*published);
  }

  LiveWorker::Inbox& inbox_;
  const LiveOptions& options_;
  DisplayLatency& display_;
  OperationRun run_;
  LiveState live_;
  worker::Recycler<LiveState> published_{[](LiveState& live) {
    live.operation = nullptr;
    live.picture = nullptr;
    live.decoration = nullptr;
  }};
  worker::Pace pace_;
  Rate rate_;
  double latency_at_s_ = 0;
  sources::SourceKind kind_ = sources::SourceKind::Simulation;
};

}  // namespace

struct LiveOperation::Thread {
  Thread(LiveOptions with, std::function<void()> on_news)
      : options(std::move(with)),
        worker(
            worker::Backlog::Lossless,
            [this](LiveWorker::Inbox& inbox) { Loop(inbox, options, display).run(); }, std::move(on_news)) {
    initial.operation = std::make_shared<const operation::OperationState>();
  }
  const LiveOptions options;
  DisplayLatency display;
  LiveState initial;
  LiveWorker worker;
};

LiveOperation::LiveOperation(LiveOptions options, std::function<void()> on_news)
    : thread_(std::make_unique<Thread>(std::move(options), std::move(on_news))) {}
LiveOperation::~LiveOperation() = default;

void LiveOperation::start(TheatreSource source) { thread_->worker.post(std::move(source)); }
void LiveOperation::end_source() { thread_->worker.post(EndSource{}); }
void LiveOperation::apply(operation::Command command) { thread_->worker.post(std::move(command)); }
void LiveOperation::keep_video(bool on) { thread_->worker.post(VideoRequest{on}); }
void LiveOperation::keep_pictures_as(recording::PicturesAs as) { thread_->worker.post(as); }
void LiveOperation::goes_on_after(const std::filesystem::path& session_folder) {
  thread_->worker.post(LeftRecord{session_folder});
}
void LiveOperation::shown(const LiveState& live, double drawn_s) {
  if (live.operation->source != nullptr && live.operation->source->kind == sources::SourceKind::Live)
    thread_->display.shown(live, drawn_s, now_s());
}
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
