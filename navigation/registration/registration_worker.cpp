#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

#include "navigation/registration/online_registration.h"

namespace arthronaut::registration {

// One thread owns the core. What comes in waits in a list under a lock that nobody holds for longer than it
// takes to append to it or to swap it; what comes out is one pointer, exchanged whole.
struct RegistrationWorker::State {
  State(std::shared_ptr<const PreparedBone> bone, const OnlineOptions& options)
      : core(std::move(bone), options) {
    published.store(std::make_shared<const OnlineResult>(core.result()));
    thread = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  void post(std::function<void(OnlineRegistration&)> work) {
    {
      const std::lock_guard lock(mutex);
      waiting.push_back(std::move(work));
      is_idle = false;
    }
    wake.notify_one();
  }

  void run(const std::stop_token& stop) {
    std::vector<std::function<void(OnlineRegistration&)>> work;
    std::unique_lock lock(mutex);
    while (wake.wait(lock, stop, [this] { return !waiting.empty(); })) {
      work.swap(waiting);
      lock.unlock();
      // One by one, so that what comes out doesn't depend on how much had come in meanwhile.
      for (const auto& item : work) {
        const std::uint64_t before = core.result().revision;
        item(core);
        if (core.update().revision != before)
          published.store(std::make_shared<const OnlineResult>(core.result()));
      }
      work.clear();
      lock.lock();
      is_idle = waiting.empty();
      if (is_idle) idle.notify_all();
      if (stop.stop_requested()) break;
    }
  }

  OnlineRegistration core;  // touched by the thread alone once it runs
  std::atomic<std::shared_ptr<const OnlineResult>> published;
  std::mutex mutex;
  std::condition_variable_any wake, idle;
  std::vector<std::function<void(OnlineRegistration&)>> waiting;
  bool is_idle = true;
  std::jthread thread;  // last: stops and joins before the rest goes
};

RegistrationWorker::RegistrationWorker(std::shared_ptr<const PreparedBone> bone, const OnlineOptions& options)
    : state_(std::make_unique<State>(std::move(bone), options)) {}
RegistrationWorker::~RegistrationWorker() = default;

void RegistrationWorker::add_points(std::span<const strokes::CurvePoint> points) {
  state_->post([points = strokes::Curves(points.begin(), points.end())](OnlineRegistration& core) {
    core.add_points(points);
  });
}

void RegistrationWorker::exclude_stroke(int curve, bool is_excluded) {
  state_->post([=](OnlineRegistration& core) { core.exclude_stroke(curve, is_excluded); });
}

void RegistrationWorker::undo_stroke() {
  state_->post([](OnlineRegistration& core) { core.undo_stroke(); });
}

void RegistrationWorker::add_touch(const Eigen::Vector3d& tip_in_marker_mm) {
  state_->post([=](OnlineRegistration& core) { core.add_touch(tip_in_marker_mm); });
}

void RegistrationWorker::touch_control_point(const Eigen::Vector3d& tip_in_marker_mm) {
  state_->post([=](OnlineRegistration& core) { core.touch_control_point(tip_in_marker_mm); });
}

void RegistrationWorker::clear_touches() {
  state_->post([](OnlineRegistration& core) { core.clear_touches(); });
}

void RegistrationWorker::clear() {
  state_->post([](OnlineRegistration& core) { core.clear(); });
}

std::shared_ptr<const OnlineResult> RegistrationWorker::latest() const { return state_->published.load(); }

void RegistrationWorker::finish() {
  std::unique_lock lock(state_->mutex);
  state_->idle.wait(lock, [this] { return state_->is_idle; });
}

}  // namespace arthronaut::registration
