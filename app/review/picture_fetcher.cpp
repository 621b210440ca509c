#include "app/review/picture_fetcher.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "navigation/recording/recorded_pictures.h"

namespace arthronaut::review {

namespace {
constexpr std::size_t kKept = 12;  // pictures of 8 MB

std::function<ReadPicture()> opening(const std::filesystem::path& folder) {
  return [folder]() -> ReadPicture {
    const auto pictures = std::make_shared<recording::RecordedPictures>(recording::read_overview(folder));
    return [pictures](const PictureWish& wish) { return pictures->picture(wish.frame, wish.timestamp_ns); };
  };
}

}  // namespace

PictureFetcher::PictureFetcher(const std::filesystem::path& session_folder, std::function<void()> on_news)
    : PictureFetcher(opening(session_folder), std::move(on_news)) {}

PictureFetcher::PictureFetcher(std::function<ReadPicture()> open, std::function<void()> on_news)
    : worker_(worker::Backlog::NewestWins, reading(std::move(open)), std::move(on_news)) {}

PictureFetcher::Worker::Body PictureFetcher::reading(std::function<ReadPicture()> open) {
  return [open = std::move(open)](Worker::Inbox& inbox) {
    const ReadPicture read = open();
    Pictures kept;
    while (const auto wish = inbox.next()) {
      if (kept.size() == kKept) kept.erase(kept.begin());
      kept.push_back({wish->frame, read(*wish)});
      inbox.publish(kept);
    }
  };
}

std::optional<Fetched> PictureFetcher::picture(const PictureWish& wish) {
  if (const auto pictures = worker_.latest()) {
    const auto found = std::find_if(pictures->rbegin(), pictures->rend(),
                                    [&](const Fetched& fetched) { return fetched.frame == wish.frame; });
    if (found != pictures->rend()) return *found;
  }
  if (std::exchange(wish_, wish.frame) != wish.frame) worker_.post(wish);
  return std::nullopt;
}

}  // namespace arthronaut::review
