#include <gmock/gmock.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/navigation/sources/cut_file.h"
#include "tests/temporary_folder.h"

namespace arthronaut::sources {
namespace {

using test::message_of;
using test::TemporaryFolder;
using ::testing::HasSubstr;

cv::Mat make_picture(int type) {
  cv::Mat picture(40, 60, type);
  cv::randu(picture, 0, 255);
  return picture;
}

// A lossless picture arrives byte for byte.
TEST(ReadPicture, GivesTheBytesOfAPng) {
  const TemporaryFolder folder;
  const cv::Mat picture = make_picture(CV_8UC3);
  cv::imwrite((folder / "p.png").string(), picture);
  const camera::Frame frame = read_picture(folder / "p.png");
  ASSERT_EQ(frame.width, 60);
  ASSERT_EQ(frame.height, 40);
  EXPECT_TRUE(std::equal(frame.bgr.begin(), frame.bgr.end(), picture.datastart, picture.dataend));
}

// A grey picture becomes BGR with three equal channels.
TEST(ReadPicture, TurnsGreyIntoBgr) {
  const TemporaryFolder folder;
  const cv::Mat picture = make_picture(CV_8UC1);
  cv::imwrite((folder / "p.png").string(), picture);
  const camera::Frame frame = read_picture(folder / "p.png");
  ASSERT_EQ(frame.bgr.size(), 3u * 60 * 40);
  for (std::size_t i = 0; i < frame.bgr.size(); ++i) ASSERT_EQ(frame.bgr[i], picture.data[i / 3]);
}

// A 16-bit picture is refused rather than scaled in silence.
TEST(ReadPicture, RefusesSixteenBits) {
  const TemporaryFolder folder;
  cv::imwrite((folder / "deep.png").string(), make_picture(CV_16UC1));
  const std::string message = message_of<InvalidInput>([&] { (void)read_picture(folder / "deep.png"); });
  EXPECT_THAT(message, HasSubstr("deep.png"));
  EXPECT_THAT(message, HasSubstr("16 bits"));
}

// Half a PNG and half a JPEG decode to half a picture in OpenCV; here both are refused.
TEST(ReadPicture, RefusesCutOffFiles) {
  const TemporaryFolder folder;
  for (const std::string name : {"p.png", "p.jpg"}) {
    cv::imwrite((folder / name).string(), make_picture(CV_8UC3));
    copy_beginning(folder / name, folder / ("half_" + name), 0.6);
    EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_picture(folder / ("half_" + name)); }),
                HasSubstr("breaks off"));
  }
}

// What is not a picture, is empty or is not there is told apart.
TEST(ReadPicture, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  std::ofstream(folder / "text.png") << "this is not a picture, it is a line of text";
  std::ofstream(folder / "empty.png");
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_picture(folder / "text.png"); }),
              HasSubstr("not a picture"));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_picture(folder / "empty.png"); }),
              HasSubstr("empty"));
  EXPECT_THROW((void)read_picture(folder / "absent.png"), IoError);
}

}  // namespace
}  // namespace arthronaut::sources
