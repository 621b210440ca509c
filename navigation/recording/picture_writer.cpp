#include "navigation/recording/picture_writer.h"

#include <atomic>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include "navigation/pipeline/bounded_queue.h"
#include "navigation/recording/video_encoder.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

constexpr std::size_t kWaitingPictures = 32;  // half a second, 200 MB at 1080p

}  // namespace

struct PictureWriter::State {
  State(const std::filesystem::path& to, double rate)
      : file(to), frames_per_second(rate), queue(kWaitingPictures) {}

  void run() {
    try {
      std::optional<VideoEncoder> encoder;
      while (const auto picture = queue.pop()) {
        const camera::Frame& frame = **picture;
        if (!encoder) encoder.emplace(file, frame.width, frame.height, frames_per_second);
        encoder->encode(frame);
      }
      if (encoder) encoder->finish();
    } catch (...) {
      error = std::current_exception();
      failed = true;
      queue.close();
      while (queue.pop()) {
      }
    }
  }

  // `error` may be read only after the thread has ended.
  void join_and_report() {
    queue.close();
    if (worker.joinable()) worker.join();
    if (error) std::rethrow_exception(std::exchange(error, nullptr));
  }

  std::filesystem::path file;
  double frames_per_second;
  pipeline::BoundedQueue<camera::FramePtr> queue;
  std::atomic<bool> failed = false;
  std::exception_ptr error;
  std::thread worker;
};

PictureWriter::PictureWriter(const std::filesystem::path& file, double frames_per_second)
    : state_(std::make_unique<State>(file, frames_per_second)) {
  state_->worker = std::thread([state = state_.get()] { state->run(); });
}

PictureWriter::~PictureWriter() {
  state_->queue.close();
  if (state_->worker.joinable()) state_->worker.join();
}

void PictureWriter::write(const camera::FramePtr& picture) {
  if (!state_->queue.push(picture)) state_->join_and_report();
}

bool PictureWriter::try_write(const camera::FramePtr& picture) {
  if (state_->failed) state_->join_and_report();
  return state_->queue.try_push(picture);
}

void PictureWriter::finish() { state_->join_and_report(); }

}  // namespace arthronaut::recording
