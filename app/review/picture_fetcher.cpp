#include "app/review/picture_fetcher.h"

#include <algorithm>
#include <utility>

#include "navigation/recording/session.h"

namespace arthronaut::review {

namespace {
constexpr std::size_t kKept = 24;  // pictures of 6 MB

std::function<std::unique_ptr<sources::FrameSource>()> opening(const std::filesystem::path& folder) {
  // The session is read once, on the worker; the video as often as a wish lies behind.
  return [folder, session = std::shared_ptr<const recording::RecordedSession>()]() mutable {
    if (session == nullptr) session = std::make_shared<const recording::RecordedSession>(folder);
    return recording::open_recorded_video(*session);
  };
}

}  // namespace

PictureFetcher::PictureFetcher(const std::filesystem::path& session_folder, std::function<void()> on_news)
    : PictureFetcher(opening(session_folder), std::move(on_news)) {}

PictureFetcher::PictureFetcher(std::function<std::unique_ptr<sources::FrameSource>()> open,
                               std::function<void()> on_news)
    : worker_(worker::Backlog::NewestWins, reading(std::move(open)), std::move(on_news)) {}

PictureFetcher::Worker::Body PictureFetcher::reading(
    std::function<std::unique_ptr<sources::FrameSource>()> open) {
  return [open = std::move(open)](Worker::Inbox& inbox) {
    std::unique_ptr<sources::FrameSource> source;
    std::int64_t at = -1;  // the frame that the source gave last
    Pictures kept;
    while (auto wish = inbox.next()) {
      // A newer wish takes the place of the one that is being read for.
      for (; wish && !inbox.stops(); wish = inbox.poll()) {
        if (source == nullptr || *wish <= at) {
          source = open();
          at = -1;
        }
        bool is_overtaken = false;
        while (at < *wish && !inbox.stops() && !is_overtaken) {
          const camera::FramePtr frame = source->next();
          if (frame == nullptr) {
            source.reset();
            break;
          }
          at = frame->index;
          if (kept.size() == kKept) kept.erase(kept.begin());
          kept.push_back(frame);
          is_overtaken = inbox.has_message();
        }
      }
      inbox.publish(kept);
    }
  };
}

camera::FramePtr PictureFetcher::picture(std::int64_t frame_index) {
  if (const auto pictures = worker_.latest()) {
    const auto found = std::find_if(pictures->rbegin(), pictures->rend(), [&](const camera::FramePtr& frame) {
      return frame->index == frame_index;
    });
    if (found != pictures->rend()) return *found;
  }
  if (std::exchange(wish_, frame_index) != frame_index) worker_.post(frame_index);
  return nullptr;
}

}  // namespace arthronaut::review
