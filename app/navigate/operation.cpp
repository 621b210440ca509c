#include "app/navigate/operation.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "app/navigate/operation_job.h"

namespace arthronaut::navigate {

namespace {

using Clock = std::chrono::steady_clock;

// A touch that was not taken is news for as long as it takes to read.
constexpr auto kNoticeStays = std::chrono::seconds(8);

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
    if (!started_ || due + std::chrono::milliseconds(100) < now) {
      started_ = true;
      start_ = now;
      first_ns_ = timestamp_ns;
      return now;
    }
    return due;
  }

 private:
  bool started_ = false;
  Clock::time_point start_;
  std::int64_t first_ns_ = 0;
};

}  // namespace

class Operation::Worker {
 public:
  Worker(OperationSetup setup, std::function<void()> on_news)
      : setup_(std::move(setup)), on_news_(std::move(on_news)) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  ~Worker() {
    request_stop();
    thread_.join();
    if (registering_.joinable()) registering_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  using Request = std::function<void(OperationJob&)>;
  void post(Request request) {
    {
      const std::lock_guard lock(mutex_);
      requests_.push_back(std::move(request));
    }
    news_.notify_all();
  }
  OperationStatus status() const {
    const std::lock_guard lock(mutex_);
    return status_;
  }
  bool is_busy() const {
    const std::lock_guard lock(mutex_);
    return status_.phase == OperationStatus::Phase::Running ||
           status_.phase == OperationStatus::Phase::Starting || status_.is_registering;
  }
  const OperationSetup& setup() const { return setup_; }

  void request_stop() {
    is_stopping_ = true;
    thread_.request_stop();
    news_.notify_all();
  }

  void start_registration() {
    if (setup_.registration->strokes_in_use().empty() || is_registering_.exchange(true)) return;
    update([](OperationStatus& s) { s.is_registering = true; });
    if (registering_.joinable()) registering_.join();
    registering_ = std::jthread([this] { run_registration(); });
  }
  void take_touch(OperationJob& job, bool is_control_point) {
    job.set_digitising(false);
    const std::string why_not = job.take_touch(is_control_point);
    update([&](OperationStatus& s) {
      s.digitises = false;
      s.touch_notice = why_not;
    });
    touch_asked_ = Clock::now();
  }
  void start_recording(OperationJob& job, const std::filesystem::path& folder) {
    job.start_recording(folder);
    update([&](OperationStatus& s) { s.recording = folder; });
  }
  void stop_recording(OperationJob& job) {
    job.stop_recording();
    update([](OperationStatus& s) { s.recording.clear(); });
  }
  void note_digitising(const OperationJob& job) {
    update([&](OperationStatus& s) { s.digitises = job.digitises(); });
  }

 private:
  template <typename Change>
  void update(const Change& change) {
    {
      const std::lock_guard lock(mutex_);
      change(status_);
    }
    on_news_();
  }

  // The top of the worker thread: whatever goes wrong becomes a state of the operation.
  void run(const std::stop_token& stop) {
    try {
      OperationJob job(setup_);
      update([&](OperationStatus& s) {
        s.phase = OperationStatus::Phase::Running;
        s.digitises = job.digitises();
        s.recording = job.is_recording() ? setup_.session_folder : std::filesystem::path();
      });
      navigate(job, stop);
      stop_recording(job);
      update([](OperationStatus& s) { s.phase = OperationStatus::Phase::Ended; });
      wait_out(job, stop);
    } catch (const std::exception& error) {
      update([&](OperationStatus& s) {
        s.phase = OperationStatus::Phase::Failed;
        s.message = error.what();
        s.recording.clear();
      });
    }
  }

  void navigate(OperationJob& job, const std::stop_token& stop) {
    Pace pace;
    while (!stop.stop_requested()) {
      run_requests(job);
      std::shared_ptr<LiveFrame> live = job.step();
      if (live == nullptr) return;
      if (!job.source_info().is_live()) wait_until(pace.due(live->picture->timestamp_ns), stop);
      publish(std::move(live));
      if (!job.recording_error().empty()) {
        update([&](OperationStatus& s) {
          s.recording_error = job.recording_error();
          s.recording.clear();
        });
      }
    }
  }

  // After the last picture: registering what was touched is still possible.
  void wait_out(OperationJob& job, const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      run_requests(job);
      std::unique_lock lock(mutex_);
      news_.wait_for(lock, std::chrono::milliseconds(200),
                     [&] { return stop.stop_requested() || !requests_.empty(); });
    }
  }

  void wait_until(Clock::time_point due, const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    news_.wait_until(lock, due, [&] { return stop.stop_requested(); });
  }

  void publish(std::shared_ptr<LiveFrame> live) {
    const Clock::time_point now = Clock::now();
    live->published_s = seconds_of(now);
    ++frames_since_;
    const double since = std::chrono::duration<double>(now - counted_from_).count();
    std::optional<double> rate;
    if (since > 1) {
      rate = frames_since_ / since;
      frames_since_ = 0;
      counted_from_ = now;
    }
    update([&](OperationStatus& s) {
      s.live = std::move(live);
      if (rate) s.frames_per_second = *rate;
      if (now - touch_asked_ > kNoticeStays) s.touch_notice.clear();
    });
  }

  void run_requests(OperationJob& job) {
    std::vector<Request> requests;
    {
      const std::lock_guard lock(mutex_);
      std::swap(requests, requests_);
    }
    for (const Request& request : requests) request(job);
  }

  // The top of the registration thread.
  void run_registration() {
    setup_.registration->register_all([this] { return !is_stopping_; });
    is_registering_ = false;
    update([](OperationStatus& s) { s.is_registering = false; });
  }

  const OperationSetup setup_;
  const std::function<void()> on_news_;
  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::vector<Request> requests_;
  OperationStatus status_;
  std::atomic<bool> is_registering_ = false, is_stopping_ = false;
  int frames_since_ = 0;
  Clock::time_point counted_from_ = Clock::now(), touch_asked_;
  std::jthread registering_, thread_;
};

Operation::Operation(OperationSetup setup, std::function<void()> on_news)
    : worker_(std::make_unique<Worker>(std::move(setup), std::move(on_news))) {}
Operation::~Operation() = default;

OperationStatus Operation::status() const { return worker_->status(); }
bool Operation::is_busy() const { return worker_->is_busy(); }
const pipeline::PipelineOptions& Operation::options() const { return worker_->setup().pipeline; }
const std::string& Operation::title() const { return worker_->setup().title; }
const std::string& Operation::calibration() const { return worker_->setup().calibration; }
double Operation::now_s() { return seconds_of(Clock::now()); }

void Operation::set_digitising(bool on) {
  worker_->post([w = worker_.get(), on](OperationJob& job) {
    job.set_digitising(on);
    w->note_digitising(job);
  });
}

void Operation::request_stop() { worker_->request_stop(); }

void Operation::take_touch(bool is_control_point) {
  worker_->post(
      [w = worker_.get(), is_control_point](OperationJob& job) { w->take_touch(job, is_control_point); });
}

void Operation::register_curves() {
  worker_->post([w = worker_.get()](OperationJob&) { w->start_registration(); });
}

void Operation::start_recording(const std::filesystem::path& session_folder) {
  worker_->post(
      [w = worker_.get(), session_folder](OperationJob& job) { w->start_recording(job, session_folder); });
}

void Operation::stop_recording() {
  worker_->post([w = worker_.get()](OperationJob& job) { w->stop_recording(job); });
}

}  // namespace arthronaut::navigate
