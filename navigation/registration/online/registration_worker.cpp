#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <iterator>
#include <mutex>
#include <stop_token>
#include <thread>

#include "navigation/registration/online/online_registration.h"

namespace arthronaut::registration {

// One thread owns the core. What comes in waits in a list under a lock that nobody holds for longer than it
// takes to append to it or to swap it; what comes out is one pointer, exchanged whole.
struct RegistrationWorker::State {
  // What the core is asked to do, and whether what comes of it is published: a step on the way is not.
  struct Piece {
    std::function<void(OnlineRegistration&)> work;
    bool is_published = true;
  };

  State(std::shared_ptr<const SurfaceIndex> bone, const OnlineOptions& options) {
    published.store(std::make_shared<const OnlineResult>());
    thread = std::jthread(
        [this, bone = std::move(bone), options](const std::stop_token& stop) { run(bone, options, stop); });
  }

  void post(std::function<void(OnlineRegistration&)> work) {
    std::vector<Piece> pieces;
    pieces.push_back({std::move(work)});
    post(std::move(pieces));
  }

  void post(std::vector<Piece> pieces) {
    {
      const std::lock_guard lock(mutex);
      if (has_ended) return;
      std::move(pieces.begin(), pieces.end(), std::back_inserter(waiting));
      is_idle = false;
    }
    wake.notify_one();
  }

  // The top of the thread. The core is made here: the search for the part of the bone that the plan lets a
  // probe reach is nothing for a frame of the screen to wait for.
  void run(const std::shared_ptr<const SurfaceIndex>& bone, const OnlineOptions& options,
           const std::stop_token& stop) {
    try {
      OnlineRegistration core(bone, options);
      work_in(core, stop);
    } catch (const std::exception& error) {  // whatever goes wrong is said by the result
      OnlineResult ended;
      ended.revision = published.load()->revision + 1;
      ended.failure = error.what();
      published.store(std::make_shared<const OnlineResult>(std::move(ended)));
    }
    const std::lock_guard lock(mutex);
    has_ended = true;
    idle.notify_all();
  }

  void work_in(OnlineRegistration& core, const std::stop_token& stop) {
    std::vector<Piece> work;
    std::unique_lock lock(mutex);
    while (true) {
      is_idle = waiting.empty();
      if (is_idle) idle.notify_all();
      if (!wake.wait(lock, stop, [this] { return !waiting.empty(); })) return;
      work.swap(waiting);
      lock.unlock();
      // One by one, so that what comes out doesn't depend on how much had come in meanwhile.
      for (const Piece& piece : work) {
        if (stop.stop_requested()) return;
        piece.work(core);
        const std::uint64_t revision = core.update().revision;
        if (piece.is_published && revision != published.load()->revision)
          published.store(std::make_shared<const OnlineResult>(core.result()));
      }
      work.clear();
      lock.lock();
    }
  }

  std::atomic<std::shared_ptr<const OnlineResult>> published;
  std::mutex mutex;
  std::condition_variable_any wake, idle;
  std::vector<Piece> waiting;
  bool is_idle = false;  // the core is made and all is worked in
  bool has_ended = false;
  std::jthread thread;  // last: stops and joins before the rest goes
};

RegistrationWorker::RegistrationWorker(std::shared_ptr<const SurfaceIndex> bone, const OnlineOptions& options)
    : state_(std::make_unique<State>(std::move(bone), options)) {}
RegistrationWorker::~RegistrationWorker() = default;

void RegistrationWorker::add_points(std::span<const strokes::CurvePoint> points) {
  state_->post([points = strokes::Curves(points.begin(), points.end())](OnlineRegistration& core) {
    core.add_points(points);
  });
}

void RegistrationWorker::take_up(std::span<const strokes::CurvePoint> points,
                                 const std::set<int>& excluded_curves) {
  std::vector<State::Piece> pieces;
  pieces.reserve(points.size() + 1);
  for (const strokes::CurvePoint& point : points) {
    const bool is_excluded = excluded_curves.contains(point.curve);
    pieces.push_back({[point, is_excluded](OnlineRegistration& core) {
                        core.add_points({&point, 1}, is_excluded);
                      },
                      false});
  }
  pieces.push_back({[](OnlineRegistration& core) { core.judge_all(); }});
  state_->post(std::move(pieces));
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
  state_->idle.wait(lock, [this] { return state_->is_idle || state_->has_ended; });
}

}  // namespace arthronaut::registration
