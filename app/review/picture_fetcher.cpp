#include "app/review/picture_fetcher.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "navigation/recording/session.h"

namespace arthronaut::review {

namespace {
constexpr std::size_t kKept = 24;  // pictures of 6 MB
}

class PictureFetcher::Worker {
 public:
  Worker(const std::filesystem::path& folder, std::function<void()> on_news)
      : folder_(folder), on_news_(std::move(on_news)) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  ~Worker() {
    thread_.request_stop();
    wish_changed_.notify_all();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  camera::FramePtr picture(std::int64_t index) {
    const std::lock_guard lock(mutex_);
    for (const camera::FramePtr& frame : kept_)
      if (frame->index == index) return frame;
    if (wish_ != index) {
      wish_ = index;
      wish_changed_.notify_all();
    }
    return nullptr;
  }
  std::string error() const {
    const std::lock_guard lock(mutex_);
    return error_;
  }

 private:
  // The top of the thread.
  void run(const std::stop_token& stop) {
    try {
      serve(stop);
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      error_ = error.what();
    }
    on_news_();
  }

  void serve(const std::stop_token& stop) {
    const recording::RecordedSession session(folder_);
    std::unique_ptr<sources::FrameSource> source;
    std::int64_t at = -1, served = -1;  // the frame that the source gave last; the wish that was met last
    while (!stop.stop_requested()) {
      const std::int64_t wish = next_wish(stop, served);
      if (wish < 0) continue;
      if (source == nullptr || wish <= at) {
        source = recording::open_recorded_video(session);
        at = -1;
      }
      while (at < wish && !stop.stop_requested() && wish == wish_now()) {
        const camera::FramePtr frame = source->next();
        if (frame == nullptr) {
          source.reset();
          break;
        }
        at = frame->index;
        keep(frame);
      }
      if (wish == wish_now()) served = wish;
      on_news_();
    }
  }

  std::int64_t next_wish(const std::stop_token& stop, std::int64_t served) {
    std::unique_lock lock(mutex_);
    wish_changed_.wait(lock, [&] { return stop.stop_requested() || wish_ != served; });
    return wish_;
  }
  std::int64_t wish_now() const {
    const std::lock_guard lock(mutex_);
    return wish_;
  }
  void keep(const camera::FramePtr& frame) {
    const std::lock_guard lock(mutex_);
    kept_.push_back(frame);
    if (kept_.size() > kKept) kept_.pop_front();
  }

  const std::filesystem::path folder_;
  const std::function<void()> on_news_;
  mutable std::mutex mutex_;
  std::condition_variable wish_changed_;
  std::int64_t wish_ = -1;
  std::deque<camera::FramePtr> kept_;
  std::string error_;
  std::jthread thread_;
};

PictureFetcher::PictureFetcher(const std::filesystem::path& session_folder, std::function<void()> on_news)
    : worker_(std::make_unique<Worker>(session_folder, std::move(on_news))) {}
PictureFetcher::~PictureFetcher() = default;
camera::FramePtr PictureFetcher::picture(std::int64_t frame_index) { return worker_->picture(frame_index); }
std::string PictureFetcher::error() const { return worker_->error(); }

}  // namespace arthronaut::review
