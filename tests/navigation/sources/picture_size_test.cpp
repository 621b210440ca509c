#include "navigation/sources/picture_size.h"

#include <gmock/gmock.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::sources {
namespace {

using test::message_of;
using test::TemporaryFolder;
using ::testing::HasSubstr;

void write_bytes(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

// What the header says is what the decoder finds, in every format that is read.
TEST(PictureSize, IsThatOfThePicture) {
  const cv::Mat picture(37, 61, CV_8UC3, cv::Scalar(10, 200, 90));
  for (const char* extension : {".png", ".jpg", ".bmp", ".tif", ".webp", ".ppm"}) {
    std::vector<std::uint8_t> bytes;
    ASSERT_TRUE(cv::imencode(extension, picture, bytes)) << extension;
    const auto size = picture_size(bytes);
    ASSERT_TRUE(size) << extension;
    EXPECT_EQ(size->width, 61U) << extension;
    EXPECT_EQ(size->height, 37U) << extension;
    const TemporaryFolder folder;
    write_bytes(folder / "p", bytes);
    EXPECT_EQ(read_picture(folder / "p").width, 61) << extension;
  }
}

// Headers that break off and bytes that are no picture say nothing, whatever they hold.
TEST(PictureSize, IsNotGuessed) {
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(cv::imencode(".jpg", cv::Mat(37, 61, CV_8UC3, cv::Scalar::all(0)), bytes));
  bytes.resize(12);
  EXPECT_FALSE(picture_size(bytes));
  EXPECT_FALSE(picture_size(std::vector<std::uint8_t>(100, 'x')));
  EXPECT_FALSE(picture_size({}));
}

// A small file whose header claims 30,000 x 30,000 pixels (2.7 GB decoded) is refused by its header, as a
// still picture and as a source.
TEST(PictureBomb, IsRefusedBeforeItIsDecoded) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> png;
  ASSERT_TRUE(cv::imencode(".png", cv::Mat(20, 20, CV_8UC3, cv::Scalar::all(0)), png));
  const auto claim = [&](std::size_t at) {
    png[at] = png[at + 1] = 0;
    png[at + 2] = 30000 >> 8;
    png[at + 3] = 30000 & 0xFF;
  };
  claim(16);
  claim(20);
  write_bytes(folder / "bomb.png", png);
  for (const std::string& message :
       {message_of<InvalidInput>([&] { (void)read_picture(folder / "bomb.png"); }),
        message_of<InvalidInput>([&] { (void)open_video(folder / "bomb.png"); })}) {
    EXPECT_THAT(message, HasSubstr("bomb.png"));
    EXPECT_THAT(message, HasSubstr("30000 x 30000"));
  }
}

}  // namespace
}  // namespace arthronaut::sources
