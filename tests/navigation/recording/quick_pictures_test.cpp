#include "navigation/recording/quick_pictures.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

#include "tests/navigation/recording/numbered_pictures.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {
namespace {

namespace fs = std::filesystem;

// The copy's number, read where it is half as large.
int number_of_copy(const camera::Frame& copy) {
  int number = 0;
  for (int bit = 0; bit < 8; ++bit) {
    const std::size_t at =
        3 * (static_cast<std::size_t>(24) * kWidth / 2 + static_cast<std::size_t>(12 + 18 * bit));
    if (copy.bgr[at] > 128) number |= 1 << bit;
  }
  return number;
}

// Copies of a video with far key frames: each of its own picture, made as a whole or not at all, and none of
// a video that was exchanged since.
TEST(QuickPictures, AreEachOfItsOwnPicture) {
  const test::TemporaryFolder folder;
  ASSERT_NO_FATAL_FAILURE(copy_numbered_video(folder / "a.mp4", "mp4v", folder / "session"));
  const auto session = std::make_shared<const SessionOverview>(read_overview(folder / "session"));
  std::vector<QuickPictures::Name> names;
  for (int i = 0; i < kFrames; ++i) names.push_back({i, test::frame_result(i).timestamp_ns});
  QuickPictures reads(session, names), makes(session, names);
  EXPECT_EQ(reads.picture(5), nullptr);
  int asked = 0;
  EXPECT_FALSE(makes.make_next(5, [&] { return ++asked < 100; }));
  EXPECT_TRUE(fs::is_empty(folder / "session/quick"));
  EXPECT_TRUE(makes.make_next(5, [] { return true; }));
  EXPECT_FALSE(makes.make_next(5, [] { return true; }));
  for (const int i : seeded_order(kFrames, 4)) {
    const camera::FramePtr copy = reads.picture(i);
    ASSERT_NE(copy, nullptr) << i;
    EXPECT_EQ(copy->width, kWidth / 2);
    EXPECT_EQ(number_of_copy(*copy), i);
    EXPECT_EQ(copy->index, i);
    EXPECT_EQ(copy->timestamp_ns, names[static_cast<std::size_t>(i)].timestamp_ns);
  }
  EXPECT_EQ(reads.picture(kFrames), nullptr);
  fs::last_write_time(session->video(), fs::last_write_time(session->video()) + std::chrono::seconds(1));
  QuickPictures of_another(session, names);
  EXPECT_EQ(of_another.picture(5), nullptr);
  EXPECT_TRUE(of_another.make_next(5, [] { return true; }));
  EXPECT_NE(of_another.picture(5), nullptr);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "session/quick"), fs::directory_iterator()), 1);
}

// Two windows may look at one session: what the other one is making stays, what a program that is gone has
// left does not.
TEST(QuickPictures, LeaveWhatAnotherWindowIsMaking) {
  const test::TemporaryFolder folder;
  ASSERT_NO_FATAL_FAILURE(copy_numbered_video(folder / "a.mp4", "mp4v", folder / "session"));
  const pid_t gone = ::fork();
  if (gone == 0) ::_exit(0);
  ::waitpid(gone, nullptr, 0);
  const fs::path quick = folder / "session/quick";
  fs::create_directory(quick);
  const auto unfinished = [&](pid_t process) {
    return quick / ("unfinished_" + std::to_string(process) + ".mkv");
  };
  for (const pid_t process : {::getppid(), gone}) std::ofstream(unfinished(process)) << "x";
  const auto session = std::make_shared<const SessionOverview>(read_overview(folder / "session"));
  std::vector<QuickPictures::Name> names;
  for (int i = 0; i < kFrames; ++i) names.push_back({i, test::frame_result(i).timestamp_ns});
  QuickPictures copies(session, names);
  EXPECT_TRUE(copies.make_next(5, [] { return true; }));
  EXPECT_TRUE(fs::exists(unfinished(::getppid())));
  EXPECT_FALSE(fs::exists(unfinished(gone)));
}

// What cannot be read has no copy, and is not tried for ever.
TEST(QuickPictures, ThereAreNoneOfACutVideo) {
  const test::TemporaryFolder folder;
  ASSERT_NO_FATAL_FAILURE(copy_numbered_video(folder / "c.mkv", "mp4v", folder / "session"));
  const auto session = std::make_shared<const SessionOverview>(read_overview(folder / "session"));
  fs::resize_file(session->video(), fs::file_size(session->video()) / 2);
  std::vector<QuickPictures::Name> names;
  for (int i = 0; i < kFrames; ++i) names.push_back({i, test::frame_result(i).timestamp_ns});
  QuickPictures copies(session, names);
  EXPECT_TRUE(copies.make_next(5, [] { return true; }));
  EXPECT_FALSE(copies.make_next(5, [] { return true; }));
  EXPECT_EQ(copies.picture(5), nullptr);
  EXPECT_TRUE(fs::is_empty(folder / "session/quick"));
}

}  // namespace
}  // namespace arthronaut::recording
