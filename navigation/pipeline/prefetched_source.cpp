#include "navigation/pipeline/prefetched_source.h"

#include <exception>
#include <thread>

#include "navigation/pipeline/bounded_queue.h"

namespace arthronaut::pipeline {

namespace {

// Four 1080p frames are 25 MB; more would not hide longer hiccups than a decoder has.
constexpr std::size_t kFramesAhead = 4;

}  // namespace

struct PrefetchedSource::State {
  explicit State(sources::FrameSource& wrapped) : source(wrapped), queue(kFramesAhead) {}

  void run() {
    try {
      while (camera::FramePtr frame = source.next()) {
        if (!queue.push(std::move(frame))) return;
      }
    } catch (...) {
      error = std::current_exception();  // handed over by the close below
    }
    queue.close();
  }

  sources::FrameSource& source;
  BoundedQueue<camera::FramePtr> queue;
  std::exception_ptr error;
  std::thread worker;
};

PrefetchedSource::PrefetchedSource(sources::FrameSource& source) : state_(std::make_unique<State>(source)) {
  state_->worker = std::thread([state = state_.get()] { state->run(); });
}

PrefetchedSource::~PrefetchedSource() {
  state_->queue.close();
  state_->worker.join();
}

const sources::SourceInfo& PrefetchedSource::info() const { return state_->source.info(); }

camera::FramePtr PrefetchedSource::next() {
  if (auto frame = state_->queue.pop()) return *frame;
  if (state_->error) std::rethrow_exception(state_->error);
  return nullptr;
}

}  // namespace arthronaut::pipeline
