#include "app/review/picture_fetcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

#include "planning/geometry/error.h"

namespace arthronaut::review {
namespace {

constexpr std::int64_t kFrames = 100;
// Long enough for any machine: what was lost would never come.
constexpr auto kPatience = std::chrono::seconds(60);

// Pictures 0 to 99, without waiting.
camera::FramePtr number(std::int64_t number) {
  if (number >= kFrames) return nullptr;
  auto frame = std::make_shared<camera::Frame>();
  frame->index = number;
  frame->timestamp_ns = number * 1000;
  return frame;
}
PictureReader numbers() {
  return {[](const PictureWish& wish, const sources::OnTheWay&) { return number(wish.frame); }};
}

PictureWish wish_of(std::int64_t frame) { return {frame, frame * 1000}; }

// Asks as the window does, frame by frame of the screen, until it was read.
std::optional<Fetched> wait_for(PictureFetcher& fetcher, std::int64_t index) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    if (auto fetched = fetcher.picture(wish_of(index))) return fetched;
    std::this_thread::yield();
  }
  return std::nullopt;
}

// However the time line is dragged, the picture where it is let go comes.
TEST(PictureFetcher, NeverLosesTheLastWish) {
  std::mt19937 random(5);
  std::uniform_int_distribution<std::int64_t> any(0, kFrames - 1);
  std::uniform_int_distribution<int> length(0, 12);
  std::atomic<long> news = 0;
  PictureFetcher fetcher(numbers, [&] { ++news; });
  for (int round = 0; round < 3000; ++round) {
    for (int drag = length(random); drag > 0; --drag) (void)fetcher.picture(wish_of(any(random)));
    const std::int64_t wish = any(random);
    const auto fetched = wait_for(fetcher, wish);
    ASSERT_TRUE(fetched && fetched->picture) << "round " << round << ", picture " << wish;
    EXPECT_EQ(fetched->picture->index, wish);
    EXPECT_EQ(fetched->picture->timestamp_ns, wish * 1000);
  }
  EXPECT_GT(news.load(), 0);
}

// Pictures of 8 MB: what was looked at long ago is let go.
TEST(PictureFetcher, KeepsFewPictures) {
  std::vector<std::weak_ptr<const camera::Frame>> given;
  const auto open = [&] {
    return PictureReader{[&](const PictureWish& wish, const sources::OnTheWay&) {
      const camera::FramePtr picture = number(wish.frame);
      given.emplace_back(picture);
      return picture;
    }};
  };
  PictureFetcher fetcher(open, [] {});
  for (std::int64_t wish = 0; wish < 30; ++wish) ASSERT_TRUE(wait_for(fetcher, wish));
  EXPECT_LE(std::count_if(given.begin(), given.end(), [](const auto& one) { return !one.expired(); }), 7);
  EXPECT_TRUE(fetcher.picture(wish_of(28)));
}

// An end that falls between the worker's test and its wait is not missed: else this would never return.
TEST(PictureFetcher, EndsAtAnyMoment) {
  for (int round = 0; round < 3000; ++round) {
    PictureFetcher fetcher(numbers, [] {});
    if (round % 3 > 0) (void)fetcher.picture(wish_of(round % kFrames));
    if (round % 3 > 1) std::this_thread::yield();
  }
}

// The video is opened once, whichever way one goes; that a frame has no picture is an answer, too, and the
// ones that were read last are not read again.
TEST(PictureFetcher, OpensOnceAndSaysWhatHasNoPicture) {
  std::atomic<int> opened = 0, read = 0;
  PictureFetcher fetcher(
      [&]() -> PictureReader {
        ++opened;
        return {[&](const PictureWish& wish, const sources::OnTheWay&) {
          ++read;
          return number(wish.frame);
        }};
      },
      [] {});
  for (const std::int64_t frame : {90, 70, 3, 90}) ASSERT_TRUE(wait_for(fetcher, frame));
  const auto beyond = wait_for(fetcher, kFrames + 5);
  ASSERT_TRUE(beyond);
  EXPECT_EQ(beyond->picture, nullptr);
  ASSERT_TRUE(wait_for(fetcher, 4));
  EXPECT_EQ(opened.load(), 1);
  EXPECT_EQ(read.load(), 5);
  EXPECT_EQ(fetcher.error(), "");
}

// A video in which every picture is decoded from the first one on, and none comes out before it is allowed
// to.
class SlowVideo {
 public:
  PictureReader reader() {
    return {[this](const PictureWish& wish, const sources::OnTheWay& on_the_way) -> camera::FramePtr {
      std::unique_lock lock(mutex_);
      for (std::int64_t at = 0; at < wish.frame; ++at) {
        const bool goes_on = on_the_way([at] { return number(at); });
        if (!goes_on) return ++left_, nullptr;
        allowed_.wait_for(lock, std::chrono::milliseconds(1), [&] { return at < limit_; });
        if (at >= limit_) --at;  // the same one again, until it may go on
      }
      return number(wish.frame);
    }};
  }
  void allow(std::int64_t limit) {
    const std::lock_guard lock(mutex_);
    limit_ = limit;
    allowed_.notify_all();
  }
  [[nodiscard]] int left() {
    const std::lock_guard lock(mutex_);
    return left_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable allowed_;
  std::int64_t limit_ = 0;
  int left_ = 0;
};

template <typename Holds>
bool comes_true(const Holds& holds) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!holds() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return holds();
}

// While a picture is looked for, the nearest that came by is there, and says that it is another one; the
// right one takes its place.
TEST(PictureFetcher, ShowsWhatComesByAsWhatItIs) {
  SlowVideo video;
  PictureFetcher fetcher([&] { return video.reader(); }, [] {});
  const auto looks_at = [&](std::int64_t wanted) {
    EXPECT_FALSE(fetcher.picture(wish_of(wanted)));
    const camera::FramePtr picture = fetcher.nearest(wish_of(wanted));
    EXPECT_TRUE(picture == nullptr || picture->timestamp_ns == picture->index * 1000);
    return picture == nullptr ? -1 : picture->index;
  };
  EXPECT_TRUE(comes_true([&] { return looks_at(50) == 0; }));
  video.allow(30);
  EXPECT_TRUE(comes_true([&] { return looks_at(50) == 30; }));
  video.allow(kFrames);
  const auto fetched = wait_for(fetcher, 50);
  ASSERT_TRUE(fetched && fetched->picture);
  EXPECT_EQ(fetched->picture->index, 50);
  EXPECT_EQ(fetcher.nearest(wish_of(52))->index, 50);  // not the one that was passed before it
}

// A search that is not wanted any more ends for the next wish, and for the end of the program.
TEST(PictureFetcher, LeavesASearchForTheNextWish) {
  SlowVideo video;
  {
    PictureFetcher fetcher([&] { return video.reader(); }, [] {});
    EXPECT_FALSE(fetcher.picture(wish_of(50)));
    EXPECT_TRUE(comes_true([&] { return fetcher.nearest(wish_of(50)) != nullptr; }));
    const auto first = wait_for(fetcher, 0);  // it takes no decoding
    ASSERT_TRUE(first && first->picture);
    EXPECT_EQ(first->picture->index, 0);
    EXPECT_FALSE(fetcher.picture(wish_of(60)));
    EXPECT_TRUE(comes_true([&] { return video.left() == 1; }));
  }
  EXPECT_EQ(video.left(), 2);
}

// What lies before is read for somebody who goes back, and until the next wish alone.
TEST(PictureFetcher, ReadsBeforeForWhoGoesBack) {
  std::atomic<int> read_before = 0, disturbed = 0;
  PictureFetcher fetcher(
      [&]() -> PictureReader {
        PictureReader reader = numbers();
        reader.read_before = [&](const std::function<bool()>& goes_on) {
          ++read_before;
          while (goes_on()) std::this_thread::yield();
          ++disturbed;
        };
        return reader;
      },
      [] {});
  for (const std::int64_t frame : {7, 8, 9}) ASSERT_TRUE(wait_for(fetcher, frame));
  EXPECT_EQ(read_before.load(), 0);
  ASSERT_TRUE(wait_for(fetcher, 6));
  EXPECT_TRUE(comes_true([&] { return read_before.load() == 1; }));
  ASSERT_TRUE(wait_for(fetcher, 20));
  EXPECT_EQ(disturbed.load(), 1);
}

// A small copy is there at once and says that it is one, until the picture itself is decoded; that this took
// long is told to whoever makes copies.
TEST(PictureFetcher, ShowsACopyUntilThePictureIsThere) {
  SlowVideo video;
  std::atomic<std::int64_t> slow = -1;
  PictureFetcher fetcher(
      [&] {
        PictureReader reader = video.reader();
        reader.copy = [](const PictureWish& wish) { return wish.frame == 50 ? number(50) : nullptr; };
        reader.was_slow = [&](const PictureWish& wish) { slow = wish.frame; };
        return reader;
      },
      [] {});
  const auto shows = [&](std::int64_t frame, bool is_copy) {
    const auto fetched = fetcher.picture(wish_of(frame));
    return fetched && fetched->picture != nullptr && fetched->picture->index == frame &&
           fetched->is_copy == is_copy;
  };
  EXPECT_TRUE(comes_true([&] { return shows(50, true); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  EXPECT_TRUE(shows(50, true));
  video.allow(kFrames);
  EXPECT_TRUE(comes_true([&] { return shows(50, false); }));
  EXPECT_TRUE(comes_true([&] { return slow == 50; }));
  // Left before it was decoded, and wished again: looked for again.
  video.allow(0);
  EXPECT_FALSE(fetcher.picture(wish_of(60)));
  EXPECT_TRUE(shows(50, false));
}

TEST(PictureFetcher, SaysHowNearAPictureIs) {
  EXPECT_EQ(nearness_in_words(1'000'000'000, 2'240'000'000), "1.24 s earlier");
  EXPECT_EQ(nearness_in_words(2'240'000'000, 2'220'000'000), "0.02 s later");
}

TEST(PictureFetcher, SaysWhyThereIsNoPicture) {
  PictureFetcher fetcher([]() -> PictureReader { throw InvalidInput("video.mkv: broken"); }, [] {});
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (fetcher.error().empty() && std::chrono::steady_clock::now() < end)
    EXPECT_FALSE(fetcher.picture(wish_of(1)));
  EXPECT_EQ(fetcher.error(), "video.mkv: broken");
}

}  // namespace
}  // namespace arthronaut::review
