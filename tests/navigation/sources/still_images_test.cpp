#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>

#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::sources {
namespace {

using test::message_of;
using test::TemporaryFolder;
using ::testing::HasSubstr;

void write_gray(const std::filesystem::path& file, int value, int width = 32) {
  cv::imwrite(file.string(), cv::Mat(24, width, CV_8UC3, cv::Scalar::all(value)));
}

// Numbered pictures come in order from the first that exists, 60 a second.
TEST(StillImages, PlaysAPatternFromItsFirstNumber) {
  const TemporaryFolder folder;
  for (int i = 7; i <= 11; ++i)
    write_gray(folder / ("f_" + std::string(i < 10 ? "000" : "00") + std::to_string(i) + ".png"), i);
  write_gray(folder / "other_0008.png", 99);
  const auto source = open_video(folder / "f_%04d.png");
  EXPECT_EQ(source->info().frame_count, 5);
  EXPECT_EQ(source->info().image_size_px, Eigen::Vector2i(32, 24));
  EXPECT_EQ(source->info().kind, SourceKind::Recording);
  for (int i = 0; i < 5; ++i) {
    const camera::FramePtr frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_EQ(frame->bgr[0], 7 + i);
    EXPECT_NEAR(static_cast<double>(frame->timestamp_ns), i * 1e9 / 60, 1.0);
  }
  EXPECT_FALSE(source->next());
}

// Numbers without leading zeros are sorted as numbers, not as text.
TEST(StillImages, SortsByNumber) {
  const TemporaryFolder folder;
  for (int i = 8; i <= 12; ++i) write_gray(folder / ("f" + std::to_string(i) + ".png"), i);
  const auto source = open_video(folder / "f%d.png");
  for (int i = 8; i <= 12; ++i) EXPECT_EQ(source->next()->bgr[0], i);
  EXPECT_FALSE(source->next());
}

// A missing picture in the middle would shift the time of all that follow.
TEST(StillImages, RefusesAGap) {
  const TemporaryFolder folder;
  for (int i : {1, 2, 4}) write_gray(folder / ("f" + std::to_string(i) + ".png"), i);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)open_video(folder / "f%d.png"); }),
              HasSubstr("picture 3"));
}

// A change of size in the middle is told with the picture's name.
TEST(StillImages, RefusesAnotherSize) {
  const TemporaryFolder folder;
  write_gray(folder / "f1.png", 1);
  write_gray(folder / "f2.png", 2, 48);
  const auto source = open_video(folder / "f%d.png");
  EXPECT_TRUE(source->next());
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)source->next(); }), HasSubstr("f2.png"));
}

// One picture is a video of one frame; a pattern that fits nothing and an absent file are told.
TEST(StillImages, OpensOnePictureAndRefusesNone) {
  const TemporaryFolder folder;
  write_gray(folder / "one.png", 5);
  const auto source = open_video(folder / "one.png");
  EXPECT_TRUE(source->next());
  EXPECT_FALSE(source->next());
  EXPECT_THROW((void)open_video(folder / "none_%03d.png"), IoError);
  EXPECT_THROW((void)open_video(folder / "none.mkv"), IoError);
}

}  // namespace
}  // namespace arthronaut::sources
