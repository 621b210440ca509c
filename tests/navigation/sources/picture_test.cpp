#include "navigation/sources/picture.h"

#include <gmock/gmock.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

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

// Whoever reads the same picture by OpenCV sees the same: to the last bit where nothing was lost in the file,
// whatever it has of transparency. Of a JPEG, whose colours every decoder rounds its own way, within two
// steps in the mean, and its luma is the one that was coded, within the rounding of a sum of three colours.
TEST(ReadPicture, AgreesWithAnotherReader) {
  const TemporaryFolder folder;
  cv::Mat smooth(240, 320, CV_8UC3);
  for (int y = 0; y < smooth.rows; ++y)
    for (int x = 0; x < smooth.cols; ++x)
      smooth.at<cv::Vec3b>(y, x) = cv::Vec3b(static_cast<std::uint8_t>(x / 2), static_cast<std::uint8_t>(y),
                                             static_cast<std::uint8_t>(200 - x / 2));
  for (const std::string name : {"p.png", "p.bmp", "p.tif", "p.ppm"}) {
    cv::imwrite((folder / name).string(), smooth);
    const camera::Frame frame = read_picture(folder / name);
    ASSERT_EQ(frame.bgr.size(), smooth.total() * 3) << name;
    EXPECT_TRUE(std::equal(frame.bgr.begin(), frame.bgr.end(), smooth.datastart, smooth.dataend)) << name;
  }
  cv::Mat transparent;
  cv::cvtColor(smooth, transparent, cv::COLOR_BGR2BGRA);
  for (int i = 0; i < transparent.rows; ++i) transparent.at<cv::Vec4b>(i, i)[3] = 0;
  cv::imwrite((folder / "t.png").string(), transparent);
  const camera::Frame opaque = read_picture(folder / "t.png");
  EXPECT_TRUE(std::equal(opaque.bgr.begin(), opaque.bgr.end(), smooth.datastart, smooth.dataend));

  cv::imwrite((folder / "p.jpg").string(), smooth);
  const camera::Frame frame = read_picture(folder / "p.jpg");
  const cv::Mat other = cv::imread((folder / "p.jpg").string());
  const cv::Mat own(frame.height, frame.width, CV_8UC3, const_cast<std::uint8_t*>(frame.bgr.data()));
  EXPECT_LT(cv::norm(own, other, cv::NORM_L1) / static_cast<double>(frame.bgr.size()), 2.0);
  cv::Mat grey;
  cv::cvtColor(other, grey, cv::COLOR_BGR2GRAY);
  ASSERT_EQ(frame.luma.size(), grey.total());
  const cv::Mat luma(frame.height, frame.width, CV_8UC1, const_cast<std::uint8_t*>(frame.luma.data()));
  EXPECT_LE(cv::norm(luma, grey, cv::NORM_INF), 2.0);
}

// A changed byte within a PNG is told by its check sums, as a decoder that only looks at the end would not.
TEST(ReadPicture, RefusesAChangedPng) {
  const TemporaryFolder folder;
  cv::imwrite((folder / "p.png").string(), make_picture(CV_8UC3));
  {
    std::fstream file(folder / "p.png", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(2000);
    file.put('x').put('y').put('z');
  }
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_picture(folder / "p.png"); }),
              HasSubstr("can be decoded"));
}

// What is written is read back to the last bit, by OpenCV too.
TEST(WritePng, KeepsEveryBit) {
  const TemporaryFolder folder;
  const cv::Mat picture = make_picture(CV_8UC3);
  camera::Frame frame;
  frame.width = picture.cols;
  frame.height = picture.rows;
  frame.bgr.assign(picture.datastart, picture.dataend);
  write_png(folder / "p.png", frame);
  EXPECT_EQ(read_picture(folder / "p.png").bgr, frame.bgr);
  EXPECT_EQ(cv::norm(cv::imread((folder / "p.png").string()), picture, cv::NORM_INF), 0);
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
