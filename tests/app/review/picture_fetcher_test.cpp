#include "app/review/picture_fetcher.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <random>
#include <thread>

#include "planning/geometry/error.h"

namespace arthronaut::review {
namespace {

constexpr std::int64_t kFrames = 100;
// Long enough for any machine: what was lost would never come.
constexpr auto kPatience = std::chrono::seconds(60);

// Pictures 0 to 99, without waiting.
ReadPicture numbers() {
  return [](const PictureWish& wish) -> camera::FramePtr {
    if (wish.frame >= kFrames) return nullptr;
    auto frame = std::make_shared<camera::Frame>();
    frame->index = wish.frame;
    frame->timestamp_ns = wish.timestamp_ns;
    return frame;
  };
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
      [&]() -> ReadPicture {
        ++opened;
        return [&, one = numbers()](const PictureWish& wish) {
          ++read;
          return one(wish);
        };
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

TEST(PictureFetcher, SaysWhyThereIsNoPicture) {
  PictureFetcher fetcher([]() -> ReadPicture { throw InvalidInput("video.mkv: broken"); }, [] {});
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (fetcher.error().empty() && std::chrono::steady_clock::now() < end)
    EXPECT_FALSE(fetcher.picture(wish_of(1)));
  EXPECT_EQ(fetcher.error(), "video.mkv: broken");
}

}  // namespace
}  // namespace arthronaut::review
