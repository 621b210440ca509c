// What leaves the screen is read back as somebody else would: by the program's own sources, which know
// nothing of how it was written.
#include "app/screen_copy/screen_copies.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::screen_copy {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 640, kHeight = 360;

// Upper half red and brighter with every picture, lower half blue.
widgets::ScreenPicture picture_of(int index, double time_s) {
  widgets::ScreenPicture picture{kWidth, kHeight, {}, time_s};
  picture.bgra.resize(4 * kWidth * kHeight);
  for (int y = 0; y < kHeight; ++y) {  // from the bottom
    for (int x = 0; x < kWidth; ++x) {
      std::uint8_t* const at = picture.bgra.data() + 4 * (y * kWidth + x);
      const bool is_upper = y >= kHeight / 2;
      at[0] = is_upper ? 20 : 220;
      at[1] = static_cast<std::uint8_t>(20);
      at[2] = is_upper ? static_cast<std::uint8_t>(120 + 2 * index) : 20;
    }
  }
  return picture;
}

std::array<int, 3> bgr_at(const camera::Frame& frame, int x, int y) {
  std::vector<std::uint8_t> made;
  const std::vector<std::uint8_t>& bgr = camera::bgr_of(frame, made);
  const auto at = static_cast<std::size_t>(3 * (y * frame.width + x));
  return {bgr[at], bgr[at + 1], bgr[at + 2]};
}

class ScreenCopiesTest : public ::testing::Test {
 protected:
  // As the window does: pictures at 30 a second, of which those that are wanted are taken.
  void show(ScreenCopies& copies, int frames) {
    for (int i = 0; i < frames; ++i, ++shown_) {
      const double now_s = shown_ / 30.0;
      if (const auto picture = copies.wanted(now_s)) {
        *picture = picture_of(shown_ % 60, now_s);
        copies.take(picture);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
      (void)copies.words(now_s);
    }
  }
  [[nodiscard]] std::string words(ScreenCopies& copies) const { return copies.words(shown_ / 30.0); }
  // Waits until the screen says so.
  [[nodiscard]] bool says(ScreenCopies& copies, const std::string& what) const {
    for (int i = 0; i < 2000; ++i) {
      if (words(copies).find(what) != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  [[nodiscard]] std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    if (fs::exists(screens_folder(folder_.path())))
      for (const auto& entry : fs::directory_iterator(screens_folder(folder_.path())))
        found.push_back(entry.path());
    return found;
  }
  const test::TemporaryFolder folder_;
  int shown_ = 0;
};

TEST_F(ScreenCopiesTest, NothingIsCopiedUnasked) {
  ScreenCopies copies("", [] {});
  show(copies, 60);
  EXPECT_EQ(copies.wanted(3), nullptr);
  EXPECT_TRUE(files().empty());
  EXPECT_EQ(words(copies), "");
}

TEST_F(ScreenCopiesTest, AScreenshotIsWhatWasShownAndItsOwnersAlone) {
  ScreenCopies copies("", [] {});
  copies.take_screenshot(folder_.path(), "");
  show(copies, 1);
  ASSERT_TRUE(says(copies, "is in the case")) << words(copies);
  ASSERT_EQ(files().size(), 1U);
  EXPECT_EQ(files()[0].extension(), ".png");
  EXPECT_EQ(fs::status(files()[0]).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  const camera::Frame shot = sources::read_picture(files()[0]);
  EXPECT_EQ(shot.width, kWidth);
  EXPECT_EQ(bgr_at(shot, 5, 5), (std::array{20, 20, 120})) << "the upper half is red";
  EXPECT_EQ(bgr_at(shot, 5, kHeight - 5), (std::array{220, 20, 20}));
  // Two in one second have two names, also while the first is still being written.
  for (int i = 0; i < 2; ++i) {
    copies.take_screenshot(folder_.path(), "");
    show(copies, 1);
  }
  const auto pictures = [this] {
    const auto all = files();
    return std::count_if(all.begin(), all.end(),
                         [](const fs::path& file) { return file.extension() == ".png"; });
  };
  for (int k = 0; k < 2000 && pictures() < 3; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(pictures(), 3);
}

TEST_F(ScreenCopiesTest, RefusalsAndFailuresAreSaid) {
  ScreenCopies copies("", [] {});
  copies.take_screenshot(folder_.path(), "the case is open elsewhere");
  EXPECT_NE(words(copies).find("open elsewhere"), std::string::npos);
  copies.toggle_recording({}, "no case is open");
  EXPECT_NE(words(copies).find("no case is open"), std::string::npos);
  EXPECT_FALSE(copies.is_recording());
  copies.toggle_stream();
  EXPECT_NE(words(copies).find("names no screen_stream"), std::string::npos);
  EXPECT_FALSE(copies.is_streaming());
  // Where there is no folder.
  copies.take_screenshot("/proc/nowhere", "");
  EXPECT_NE(words(copies).find("No screenshot"), std::string::npos);
  EXPECT_EQ(copies.wanted(0), nullptr);
  EXPECT_TRUE(files().empty());
}

// The file is there whole when it is ended, in the screen's own time, with no more than 15 pictures a second.
TEST_F(ScreenCopiesTest, AFileHoldsTheScreenInItsOwnTime) {
  {
    std::atomic<int> woken = 0;
    ScreenCopies copies("", [&woken] { ++woken; });
    copies.toggle_recording(folder_.path(), "");
    EXPECT_TRUE(copies.is_recording());
    show(copies, 60);
    EXPECT_NE(words(copies).find("SCREEN IS RECORDED 0:0"), std::string::npos) << words(copies);
    for (const fs::path& file : files()) EXPECT_EQ(file.extension(), ".part") << "not whole yet";
    copies.toggle_recording(folder_.path(), "");
    EXPECT_FALSE(copies.is_recording());
    // Not before it is.
    while (words(copies).empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_NE(words(copies).find("The screen is in the case"), std::string::npos) << words(copies);
    for (const fs::path& file : files()) EXPECT_EQ(file.extension(), ".mkv");
    EXPECT_GE(woken, 1) << "a screen that stands still is drawn again";
  }
  ASSERT_EQ(files().size(), 1U);
  ASSERT_EQ(files()[0].extension(), ".mkv");
  EXPECT_EQ(fs::status(files()[0]).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  const auto video = sources::open_video(files()[0]);
  EXPECT_EQ(video->info().image_size_px, Eigen::Vector2i(kWidth, kHeight));
  int count = 0;
  camera::FramePtr last;
  while (const camera::FramePtr frame = video->next()) {
    ++count;
    last = frame;
  }
  // 30 of 60, of which a busy machine leaves some out: the newest wins.
  EXPECT_GE(count, 2);
  EXPECT_LE(count, 31);
  ASSERT_NE(last, nullptr);
  // Lossy, and with colours of half the resolution.
  const auto upper = bgr_at(*last, 100, 20), lower = bgr_at(*last, 100, kHeight - 20);
  EXPECT_GT(upper[2], upper[0] + 80);
  EXPECT_GT(lower[0], lower[2] + 80);
}

// What was shown when it was ended is in it, however busy the machine is.
TEST_F(ScreenCopiesTest, ThePictureThatWaitsAtTheEndIsWritten) {
  ScreenCopies copies("", [] {});
  copies.toggle_recording(folder_.path(), "");
  const auto picture = copies.wanted(0);
  ASSERT_NE(picture, nullptr);
  *picture = picture_of(0, 0);
  copies.take(picture);
  copies.toggle_recording(folder_.path(), "");
  EXPECT_TRUE(says(copies, "is in the case")) << words(copies);
  ASSERT_EQ(files().size(), 1U);
  EXPECT_NE(sources::open_video(files()[0])->next(), nullptr);
}

// What cannot be written is not said to be in the case, but why not; what there is stays.
TEST_F(ScreenCopiesTest, AFileThatIsNotWholeIsSaidWithTheReason) {
  ScreenCopies copies("", [] {});
  copies.toggle_recording(folder_.path(), "");
  show(copies, 30);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  const rlimit full{1, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &full);  // as a disk that is full, from now on
  copies.toggle_recording(folder_.path(), "");
  const bool is_said = says(copies, "The recording of the screen is not whole");
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  EXPECT_TRUE(is_said) << words(copies);
  EXPECT_NE(words(copies).find(".mkv: cannot be written: File too large"), std::string::npos)
      << words(copies);
  EXPECT_EQ(words(copies).find("is in the case"), std::string::npos);
  ASSERT_EQ(files().size(), 1U);
  EXPECT_EQ(files()[0].extension(), ".part");
  // Ended before there was any picture.
  copies.toggle_recording(folder_.path(), "");
  copies.toggle_recording(folder_.path(), "");
  EXPECT_TRUE(says(copies, "ended before its first picture")) << words(copies);
  EXPECT_EQ(files().size(), 1U);
}

// A window that changes its size goes on in the first one's.
TEST_F(ScreenCopiesTest, AnotherSizeGoesOnInTheFirst) {
  const std::string file = folder_ / "screen.mkv";
  ScreenEncoder encoder(file, 641, 361);
  for (int i = 0; i < 10; ++i) encoder.encode(picture_of(i, 0.1 * i));
  encoder.finish();
  const auto video = sources::open_video(file);
  EXPECT_EQ(video->info().image_size_px, Eigen::Vector2i(640, 360));
}

// Sent to a port of this machine, where the program's own reader of streams listens.
TEST_F(ScreenCopiesTest, AStreamIsSeenByWhoeverListens) {
  const std::string address = "udp://127.0.0.1:" + std::to_string(20000 + ::getpid() % 40000);
  ScreenCopies copies(address, [] {});
  copies.toggle_stream();
  EXPECT_NE(words(copies).find("SCREEN IS SENT to " + address), std::string::npos) << words(copies);
  std::atomic<bool> ends = false;
  std::thread screen([&] {
    while (!ends) show(copies, 2);
  });
  int count = 0;
  try {
    const auto stream = sources::open_stream(address);
    EXPECT_EQ(stream->info().image_size_px, Eigen::Vector2i(kWidth, kHeight));
    for (; count < 30; ++count) {
      const camera::FramePtr frame = stream->next();
      ASSERT_NE(frame, nullptr);
      EXPECT_GT(bgr_at(*frame, 100, 20)[2], 90);
    }
  } catch (const DeviceError& error) {
    ADD_FAILURE() << error.what();
  }
  ends = true;
  screen.join();
  EXPECT_EQ(count, 30);
}

}  // namespace
}  // namespace arthronaut::screen_copy
