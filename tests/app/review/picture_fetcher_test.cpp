#include "app/review/picture_fetcher.h"

#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <thread>

#include "planning/geometry/error.h"

namespace arthronaut::review {
namespace {

constexpr std::int64_t kFrames = 100;
// Long enough for any machine: what was lost would never come.
constexpr auto kPatience = std::chrono::seconds(60);

// Pictures 0 to 99, without waiting.
class Numbers : public sources::FrameSource {
 public:
  [[nodiscard]] const sources::SourceInfo& info() const override { return info_; }
  [[nodiscard]] camera::FramePtr next() override {
    if (next_ == kFrames) return nullptr;
    auto frame = std::make_shared<camera::Frame>();
    frame->index = next_++;
    return frame;
  }

 private:
  std::int64_t next_ = 0;
  sources::SourceInfo info_;
};

std::unique_ptr<sources::FrameSource> open_numbers() { return std::make_unique<Numbers>(); }

// Asks as the window does, frame by frame of the screen, until the picture is there.
camera::FramePtr wait_for(PictureFetcher& fetcher, std::int64_t index) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    if (camera::FramePtr picture = fetcher.picture(index)) return picture;
    std::this_thread::yield();
  }
  return nullptr;
}

// However the time line is dragged, the picture where it is let go comes.
TEST(PictureFetcher, NeverLosesTheLastWish) {
  std::mt19937 random(5);
  std::uniform_int_distribution<std::int64_t> any(0, kFrames - 1);
  std::uniform_int_distribution<int> length(0, 12);
  std::atomic<long> news = 0;
  PictureFetcher fetcher(open_numbers, [&] { ++news; });
  for (int round = 0; round < 3000; ++round) {
    for (int drag = length(random); drag > 0; --drag) (void)fetcher.picture(any(random));
    const std::int64_t wish = any(random);
    const camera::FramePtr picture = wait_for(fetcher, wish);
    ASSERT_NE(picture, nullptr) << "round " << round << ", picture " << wish;
    EXPECT_EQ(picture->index, wish);
  }
  EXPECT_GT(news.load(), 0);
}

// An end that falls between the worker's test and its wait is not missed: else this would never return.
TEST(PictureFetcher, EndsAtAnyMoment) {
  for (int round = 0; round < 3000; ++round) {
    PictureFetcher fetcher(open_numbers, [] {});
    if (round % 3 > 0) (void)fetcher.picture(round % kFrames);
    if (round % 3 > 1) std::this_thread::yield();
  }
}

// What lies behind is read from the start again; what is beyond the end never comes and does no harm.
TEST(PictureFetcher, GoesBackAndBeyond) {
  std::atomic<int> opened = 0;
  PictureFetcher fetcher(
      [&] {
        ++opened;
        return open_numbers();
      },
      [] {});
  ASSERT_NE(wait_for(fetcher, 90), nullptr);
  EXPECT_EQ(opened.load(), 1);
  ASSERT_NE(wait_for(fetcher, 70), nullptr);  // kept: no second reading
  EXPECT_EQ(opened.load(), 1);
  ASSERT_NE(wait_for(fetcher, 3), nullptr);
  EXPECT_EQ(opened.load(), 2);
  EXPECT_EQ(fetcher.picture(kFrames + 5), nullptr);
  ASSERT_NE(wait_for(fetcher, 4), nullptr);
  EXPECT_EQ(fetcher.error(), "");
}

TEST(PictureFetcher, SaysWhyThereIsNoPicture) {
  PictureFetcher fetcher(
      []() -> std::unique_ptr<sources::FrameSource> { throw InvalidInput("video.mkv: broken"); }, [] {});
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (fetcher.error().empty() && std::chrono::steady_clock::now() < end)
    EXPECT_EQ(fetcher.picture(1), nullptr);
  EXPECT_EQ(fetcher.error(), "video.mkv: broken");
}

}  // namespace
}  // namespace arthronaut::review
