#include "app/review/picture_fetcher.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "app/review/copy_maker.h"
#include "navigation/recording/quick_pictures.h"
#include "navigation/recording/recorded_pictures.h"
#include "planning/files/format.h"

namespace arthronaut::review {

namespace {

constexpr std::size_t kKept = 6;  // pictures of 8 MB
// Of what is passed on the way to a picture, so much is shown: the first at once, then ten a second.
constexpr auto kShowEvery = std::chrono::milliseconds(100);
// Longer, and copies are made.
constexpr auto kSlow = std::chrono::milliseconds(100);

// The frame that a passed picture is of, by the one of its names that it has (recorded_pictures.h).
camera::FramePtr named(const camera::FramePtr& picture, const std::vector<recording::FrameGlance>& frames) {
  if (picture == nullptr || frames.empty()) return nullptr;
  const bool has_index = picture->index >= 0;
  auto found = std::lower_bound(frames.begin(), frames.end(), *picture,
                                [has_index](const recording::FrameGlance& f, const camera::Frame& p) {
                                  return has_index ? f.index < p.index : f.timestamp_ns < p.timestamp_ns;
                                });
  if (has_index && (found == frames.end() || found->index != picture->index)) return nullptr;
  // A file's clock may be coarse: the nearer of the two that a time lies between.
  const auto distance_ns = [&](auto at) { return std::abs(at->timestamp_ns - picture->timestamp_ns); };
  if (found == frames.end() ||
      (!has_index && found != frames.begin() && distance_ns(std::prev(found)) < distance_ns(found)))
    --found;
  auto frame = std::make_shared<camera::Frame>(*picture);
  frame->index = found->index;
  frame->timestamp_ns = found->timestamp_ns;
  return frame;
}

std::vector<recording::QuickPictures::Name> names_of(const std::vector<recording::FrameGlance>& frames) {
  std::vector<recording::QuickPictures::Name> names;
  names.reserve(frames.size());
  for (const recording::FrameGlance& frame : frames) names.push_back({frame.index, frame.timestamp_ns});
  return names;
}

std::function<PictureReader()> opening(const SessionReview& review) {
  return [session = review.session, timeline = review.timeline, opened = review.pictures]() -> PictureReader {
    const auto pictures = opened != nullptr ? opened : std::make_shared<recording::RecordedPictures>(session);
    const auto copies = std::make_shared<recording::QuickPictures>(session, names_of(timeline->frames()));
    const auto making = std::make_shared<std::unique_ptr<CopyMaker>>();
    return {[pictures, timeline](const PictureWish& wish, const sources::OnTheWay& on_the_way) {
              return pictures->picture(wish.frame, wish.timestamp_ns, [&](const auto& passed) {
                return on_the_way([&] { return named(passed(), timeline->frames()); });
              });
            },
            [pictures](const std::function<bool()>& goes_on) { pictures->read_before_remembered(goes_on); },
            [copies](const PictureWish& wish) { return copies->picture(wish.frame); },
            [making, session, timeline](const PictureWish& wish) {
              if (*making == nullptr)
                *making = std::make_unique<CopyMaker>(session, names_of(timeline->frames()));
              (*making)->make_about(wish.frame);
            }};
  };
}

}  // namespace

PictureFetcher::PictureFetcher(const SessionReview& review, std::function<void()> on_news)
    : PictureFetcher(opening(review), std::move(on_news)) {}

PictureFetcher::PictureFetcher(std::function<PictureReader()> open, std::function<void()> on_news)
    : worker_(worker::Backlog::NewestWins, reading(std::move(open)), std::move(on_news)) {}

PictureFetcher::Worker::Body PictureFetcher::reading(std::function<PictureReader()> open) {
  return [open = std::move(open)](Worker::Inbox& inbox) {
    using Clock = std::chrono::steady_clock;
    const PictureReader reader = open();
    Pictures kept;
    const auto keep = [&](std::int64_t frame, const camera::FramePtr& picture, bool is_copy = false) {
      if (kept.size() == kKept) kept.erase(kept.begin());
      kept.push_back({frame, picture, is_copy});
      inbox.publish(kept);
    };
    const auto is_undisturbed = [&] { return !inbox.has_message() && !inbox.stops(); };
    std::int64_t last_ns = 0;
    while (const auto wish = inbox.next()) {
      Clock::time_point shows_again{};
      bool is_wanted = true, has_passed = false;
      const camera::FramePtr copy = reader.copy ? reader.copy(*wish) : nullptr;
      if (copy != nullptr) keep(wish->frame, copy, true);
      const auto begin = Clock::now();
      const camera::FramePtr picture = reader.read(*wish, [&](const auto& passed) {
        // One at least of each search, so that something moves however fast wishes come.
        if (copy == nullptr && Clock::now() >= shows_again) {
          if (const camera::FramePtr on_the_way = passed()) {
            if (std::exchange(has_passed, true)) kept.pop_back();
            keep(on_the_way->index, on_the_way);
          }
          shows_again = Clock::now() + kShowEvery;
        }
        return is_wanted = is_undisturbed();
      });
      if (is_wanted) keep(wish->frame, picture);
      if (reader.was_slow && Clock::now() - begin > kSlow) reader.was_slow(*wish);
      const bool goes_back = wish->timestamp_ns < std::exchange(last_ns, wish->timestamp_ns);
      if (goes_back && reader.read_before && is_undisturbed()) reader.read_before(is_undisturbed);
    }
  };
}

std::optional<Fetched> PictureFetcher::picture(const PictureWish& wish) {
  std::optional<Fetched> known;
  if (const auto pictures = worker_.latest()) {
    const auto found = std::find_if(pictures->rbegin(), pictures->rend(),
                                    [&](const Fetched& fetched) { return fetched.frame == wish.frame; });
    if (found != pictures->rend()) known = *found;
  }
  if (known && !known->is_copy) return known;
  if (std::exchange(wish_, wish.frame) != wish.frame) worker_.post(wish);
  return known;
}

camera::FramePtr PictureFetcher::nearest(const PictureWish& wish) const {
  camera::FramePtr nearest;
  const auto distance_ns = [&](const camera::Frame& of) {
    return std::abs(of.timestamp_ns - wish.timestamp_ns);
  };
  if (const auto pictures = worker_.latest())
    for (const Fetched& fetched : *pictures)
      if (fetched.picture && (!nearest || distance_ns(*fetched.picture) < distance_ns(*nearest)))
        nearest = fetched.picture;
  return nearest;
}

std::string nearness_in_words(std::int64_t picture_ns, std::int64_t wanted_ns) {
  return files::format("%.2f s %s", static_cast<double>(std::abs(picture_ns - wanted_ns)) * 1e-9,
                       picture_ns < wanted_ns ? "earlier" : "later");
}

}  // namespace arthronaut::review
