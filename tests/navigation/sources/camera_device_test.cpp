// The real source on cameras that are none (tests/fake_camera).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "navigation/sources/camera_facts.h"
#include "navigation/sources/capture_time.h"
#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "tests/fake_camera/camera_room.h"
#include "tests/message_of.h"

namespace arthronaut::sources {
namespace {

using std::chrono::milliseconds;
using test::CameraRoom;
using test::FakeClock;
using test::message_of;
using ::testing::HasSubstr;

// Smooth, so that compression leaves it nearly as it was; each picture another one.
cv::Mat shaded(int width, int height, int number) {
  cv::Mat picture(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      picture.at<cv::Vec3b>(y, x) = cv::Vec3b(static_cast<std::uint8_t>(60 + 100 * x / width),
                                              static_cast<std::uint8_t>(40 + 20 * number + 80 * y / height),
                                              static_cast<std::uint8_t>(180 - 90 * x / width));
  return picture;
}

std::vector<cv::Mat> clip(int width = 160, int height = 120) {
  std::vector<cv::Mat> pictures;
  for (int i = 0; i < 5; ++i) pictures.push_back(shaded(width, height, i));
  return pictures;
}

// Which picture of the clip this is, by its luma: the nearest, and how far it is from it at most.
struct Seen {
  std::size_t number = 0;
  double luma_differs = 255, colours_differ = 255;
};
Seen look(const camera::Frame& frame, const std::vector<cv::Mat>& pictures) {
  std::vector<std::uint8_t> luma_scratch, bgr_scratch;
  const camera::GrayView view = luma_of(frame, luma_scratch);
  const cv::Mat luma(view.height, view.width, CV_8UC1, const_cast<std::uint8_t*>(view.data),
                     static_cast<std::size_t>(view.stride));
  std::vector<std::uint8_t> bgr = bgr_of(frame, bgr_scratch);
  const cv::Mat colours(frame.height, frame.width, CV_8UC3, bgr.data());
  Seen seen;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    cv::Mat grey;
    cv::cvtColor(pictures[i], grey, cv::COLOR_BGR2GRAY);
    const double differs = cv::norm(grey, luma, cv::NORM_INF);
    if (differs < seen.luma_differs)
      seen = {i, differs,
              cv::norm(pictures[i], colours, cv::NORM_L1) / static_cast<double>(3 * grey.total())};
  }
  return seen;
}

// Waits until the line says so; how long it took, in ms, or -1.
long told_after_ms(FrameSource& source, const std::string& words) {
  const auto begun = std::chrono::steady_clock::now();
  std::jthread reader([&source] {
    while (source.next() != nullptr) {
    }
  });
  long taken_ms = -1;
  for (int i = 0; i < 2000 && taken_ms < 0; ++i) {
    const SourceLine& line = *source.info().line;
    if ((line.trouble() + line.remark()).find(words) != std::string::npos)
      taken_ms = std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now() - begun).count();
    else
      std::this_thread::sleep_for(milliseconds(5));
  }
  source.info().line->end();
  return taken_ms;
}

struct Format {
  const char* name;
  std::uint32_t fourcc;
  bool has_colours = true;
};
class CameraFormat : public ::testing::TestWithParam<Format> {};

// Every format shows what stands before the camera. Luma of 16 to 235 is exact to one step up and down; JPEG,
// at quality 95, to three more. Colours that were halved in size are judged in the mean.
TEST_P(CameraFormat, ShowsWhatStandsBeforeIt) {
  CameraRoom room;
  const auto pictures = clip();
  room.add_mode(0, GetParam().fourcc, pictures, {100});
  room.plug();
  const auto source = open_source(std::string("/dev/video0?format=") + GetParam().name);
  EXPECT_EQ(source->info().image_size_px, Eigen::Vector2i(160, 120));
  EXPECT_DOUBLE_EQ(source->info().frames_per_second, 100);
  EXPECT_TRUE(source->info().is_live());
  for (int i = 0; i < 12; ++i) {
    const camera::FramePtr frame = source->next();
    ASSERT_NE(frame, nullptr);
    const Seen seen = look(*frame, pictures);
    EXPECT_EQ(seen.number, static_cast<std::size_t>(frame->index % 5));
    EXPECT_LE(seen.luma_differs, 4);
    if (GetParam().has_colours) {
      EXPECT_LT(seen.colours_differ, 2.5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, CameraFormat,
    ::testing::Values(Format{"nv12", V4L2_PIX_FMT_NV12}, Format{"yu12", V4L2_PIX_FMT_YUV420},
                      Format{"p010", V4L2_PIX_FMT_P010}, Format{"yuyv", V4L2_PIX_FMT_YUYV},
                      Format{"uyvy", V4L2_PIX_FMT_UYVY}, Format{"bgr24", V4L2_PIX_FMT_BGR24},
                      Format{"rgb24", V4L2_PIX_FMT_RGB24}, Format{"grey", V4L2_PIX_FMT_GREY, false},
                      Format{"mjpeg", V4L2_PIX_FMT_MJPEG}),
    [](const auto& one) { return std::string(one.param.name); });

// A plane that uses all steps is looked at where the driver wrote it, and what is held is never written over:
// not while the camera goes on, not when its memory is short, not when it is unplugged.
TEST(CameraDevice, PicturesStandWhileSomebodyLooks) {
  CameraRoom room;
  std::vector<std::vector<std::uint8_t>> pictures;
  for (int i = 0; i < 40; ++i) pictures.emplace_back(64 * 48 * 3 / 2, static_cast<std::uint8_t>(5 * i));
  room.add_mode(0, V4L2_PIX_FMT_NV12, {64, 48}, pictures, {200}).quantization = V4L2_QUANTIZATION_FULL_RANGE;
  room.plug();
  std::vector<camera::FramePtr> held;
  int in_place = 0;
  {
    const auto source = open_source("/dev/video0");
    for (int i = 0; i < 20; ++i) {
      held.push_back(source->next());
      in_place += held.back()->luma.empty() ? 1 : 0;
    }
    room.unplug();
  }
  EXPECT_EQ(in_place, 20);
  EXPECT_EQ(room.camera().streaming, 0);
  for (const camera::FramePtr& frame : held) {
    std::vector<std::uint8_t> scratch;
    const camera::GrayView luma = luma_of(*frame, scratch);
    EXPECT_TRUE(scratch.empty());
    const auto shown = static_cast<std::uint8_t>(5 * (frame->index % 40));
    EXPECT_EQ(luma.row(0)[0], shown);
    EXPECT_EQ(luma.row(47)[63], shown);
  }
}

// The driver's stamp where it stands on the monotonic clock; of any other the moment of handing over, and the
// frame says which.
TEST(CameraDevice, PicturesCarryTheTimeOfTheirCapture) {
  for (const FakeClock clock : {FakeClock::Monotonic, FakeClock::Wall, FakeClock::None}) {
    CameraRoom room;
    room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(), {50});
    room.camera().clock = clock;
    room.plug();
    const auto source = open_source("/dev/video0");
    (void)source->next();
    const camera::FramePtr first = source->next(), second = source->next();
    const bool is_stamped = clock == FakeClock::Monotonic;
    EXPECT_EQ(first->capture_clock,
              is_stamped ? camera::CaptureClock::Driver : camera::CaptureClock::HandedOver);
    EXPECT_LE(first->captured_ns, first->received_ns);
    EXPECT_LE(first->received_ns, first->decoded_ns);
    if (!is_stamped) {
      EXPECT_EQ(first->captured_ns, first->received_ns);
    }
    if (is_stamped) {
      // The fake's pictures are 20 ms apart to the microsecond in which V4L2 counts, whatever this machine
      // does.
      EXPECT_NEAR(static_cast<double>(second->timestamp_ns - first->timestamp_ns) * 1e-6,
                  20.0 * static_cast<double>(second->index - first->index), 0.002);
    }
  }
}

TEST(CameraDevice, TakesTheModeThatIsWished) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(64, 48), {30});
  room.add_mode(0, V4L2_PIX_FMT_MJPEG, clip(320, 240), {60, 30});
  room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(320, 240), {5});
  room.plug();
  EXPECT_EQ(open_source("/dev/video0")->info().image_size_px, Eigen::Vector2i(320, 240));
  EXPECT_EQ(room.camera().mode_in_use, 1U);
  EXPECT_EQ(room.camera().rate_in_use, 60U);
  EXPECT_EQ(open_source("/dev/video0?rate=30&format=mjpeg")->info().frames_per_second, 30);
  EXPECT_EQ(open_source("/dev/video0?format=yuyv")->info().image_size_px, Eigen::Vector2i(64, 48));
  EXPECT_EQ(open_source("/dev/video0?format=yuyv&size=320x240")->info().frames_per_second, 5);
  EXPECT_THAT(
      message_of<DeviceError>([] { (void)open_source("/dev/video0?size=1920x1080"); }),
      HasSubstr("camera 0: gives nothing that can be read as asked for (1920 x 1080); it gives 320 x 240, "
                "30/s, mjpeg; "));
  EXPECT_EQ(room.camera().most_streaming, 1);
}

// An analogue input: the standard that is wished, by its name or family, else the one on the line.
TEST(CameraDevice, TakesTheStandardThatIsWished) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_UYVY, clip(), {25}).field = V4L2_FIELD_INTERLACED;
  room.camera().tells_sizes = false;
  room.camera().standards = V4L2_STD_PAL | V4L2_STD_NTSC;
  room.camera().standard = V4L2_STD_NTSC;
  room.plug();
  (void)open_source("/dev/video0");
  EXPECT_EQ(room.camera().standard, V4L2_STD_NTSC);
  (void)open_source("/dev/video0?standard=pal");
  EXPECT_EQ(room.camera().standard, V4L2_STD_PAL);
  EXPECT_THAT(message_of<DeviceError>([] { (void)open_source("/dev/video0?standard=secam"); }),
              HasSubstr("knows no standard \"secam\": PAL, NTSC"));
  EXPECT_THAT(message_of<DeviceError>([] { (void)open_source("/dev/video0?input=3"); }),
              HasSubstr("has no input 3"));
}

// What keeps a camera from being opened, in words.
TEST(CameraDevice, SaysWhyItCannotBeOpened) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(), {30});
  const auto refusal = [] { return message_of<DeviceError>([] { (void)open_source("/dev/video0"); }); };
  EXPECT_EQ(refusal(), "camera 0: is not connected");
  room.plug();
  room.camera().open_error = EACCES;
  EXPECT_THAT(refusal(), HasSubstr("join the group \"video\""));
  room.camera().open_error = 0;
  room.camera().is_busy = true;
  EXPECT_EQ(refusal(), "camera 0: is in use by another program");
  room.camera().is_busy = false;
  room.camera().input_status = V4L2_IN_ST_NO_SIGNAL;
  EXPECT_THAT(refusal(), HasSubstr("camera 0: no signal"));
  room.camera().input_status = 0;
  room.camera().is_stalled = true;
  EXPECT_THAT(refusal(), HasSubstr("camera 0: gives no picture"));
  room.camera().is_stalled = false;
  room.plug(1);  // the metadata of a webcam
  EXPECT_THAT(message_of<DeviceError>([] { (void)open_source("/dev/video1"); }),
              HasSubstr("gives no pictures"));
  EXPECT_NE(open_source("/dev/video0")->next(), nullptr);
}

struct Fault {
  const char* name;
  void (*begins)(CameraRoom&);
  void (*ends)(CameraRoom&);
  const char* words;
};
class CameraFault : public ::testing::TestWithParam<Fault> {};

// Told within half a second, and pictures come again by themselves when it is over. (The half second is held
// by a machine that has time: here it may take three, so that a busy one does not fail it, and is printed.)
TEST_P(CameraFault, IsToldAndIsOverWhenItIsOver) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(), {60});
  room.plug();
  const auto source = open_source("/dev/video0");
  ASSERT_NE(source->next(), nullptr);
  GetParam().begins(room);
  const auto begun = std::chrono::steady_clock::now();
  std::atomic<long> given = 0;
  std::jthread reader([&] {
    while (source->next() != nullptr) ++given;
  });
  const auto wait_for = [&](const auto& is_so) {
    for (int i = 0; i < 600 && !is_so(); ++i) std::this_thread::sleep_for(milliseconds(5));
    return is_so();
  };
  EXPECT_TRUE(wait_for([&] {
    return source->info().line->trouble().find(GetParam().words) != std::string::npos;
  })) << source->info().line->trouble();
  RecordProperty(
      "told_after_ms",
      std::to_string(
          std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now() - begun).count()));
  GetParam().ends(room);
  const long before = given;
  EXPECT_TRUE(wait_for([&] { return given > before + 3 && source->info().line->trouble().empty(); }))
      << source->info().line->trouble();
  source->info().line->end();
}

INSTANTIATE_TEST_SUITE_P(
    All, CameraFault,
    ::testing::Values(
        Fault{"Unplugged", [](CameraRoom& room) { room.unplug(); }, [](CameraRoom& room) { room.plug(); },
              "camera 0: is not connected"},
        Fault{"Stalled", [](CameraRoom& room) { room.camera().is_stalled = true; },
              [](CameraRoom& room) { room.camera().is_stalled = false; }, "camera 0: gives no picture"},
        Fault{"NoSignal", [](CameraRoom& room) { room.camera().input_status = V4L2_IN_ST_NO_SIGNAL; },
              [](CameraRoom& room) { room.camera().input_status = 0; }, "camera 0: no signal"},
        Fault{"InputOutputError", [](CameraRoom& room) { room.camera().picture_error = EIO; },
              [](CameraRoom& room) { room.camera().picture_error = 0; }, "answers with an error"},
        Fault{"Damaged", [](CameraRoom& room) { room.camera().damages = 1'000'000; },
              [](CameraRoom& room) { room.camera().damages = 0; }, "every picture comes damaged"}),
    [](const auto& one) { return std::string(one.param.name); });

// The signal of a capture card becomes another one: nothing of another size is given on, and it is said.
TEST(CameraDevice, TellsThatTheFormatHasChanged) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(320, 240), {60});
  room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(64, 48), {60});
  room.camera().tells_sizes = false;
  room.plug();
  const auto source = open_source("/dev/video0");
  ASSERT_NE(source->next(), nullptr);
  room.camera().first_mode = 1;
  ++room.camera().source_changes;
  EXPECT_GE(
      told_after_ms(*source, "the source's format changed to 64 x 48: set the processor back to 320 x 240"),
      0);
}

// A card whose signal comes back in another format is refused for as long as that lasts, and taken up again
// by itself with the right one: also where its driver says nothing of the change.
TEST(CameraDevice, IsTakenUpAgainInTheRightFormat) {
  for (const bool is_told : {true, false}) {
    CameraRoom room;
    room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(320, 240), {60});
    room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(64, 48), {60});
    room.camera().tells_sizes = false;
    room.plug();
    const auto source = open_source("/dev/video0");
    ASSERT_NE(source->next(), nullptr);
    room.camera().first_mode = 1;
    ++room.camera().source_changes;
    std::jthread looker([&, line = source->info().line] {
      const auto waits_for = [](const auto& is_so) {
        for (int i = 0; i < 5000 && !is_so(); ++i) std::this_thread::sleep_for(milliseconds(1));
        return is_so();
      };
      EXPECT_TRUE(waits_for([&] { return line->trouble().find("changed to 64 x 48") != std::string::npos; }))
          << line->trouble();
      room.camera().first_mode = 0;
      if (is_told) ++room.camera().source_changes;
      EXPECT_TRUE(waits_for([&] { return line->trouble().empty(); })) << line->trouble();
      if (!line->trouble().empty()) line->end();
    });
    for (int count = 0; count < 30; ++count) {
      const camera::FramePtr frame = source->next();
      ASSERT_NE(frame, nullptr) << is_told;
      EXPECT_EQ(frame->width, 320);
    }
  }
}

// A camera that has more modes when it is plugged in again (another socket) goes on in the one that it had.
TEST(CameraDevice, GoesOnInItsModeWhereItHasLargerOnesByNow) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(64, 48), {60});
  room.plug();
  const auto source = open_source("/dev/video0");
  ASSERT_NE(source->next(), nullptr);
  room.unplug();
  room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(320, 240), {60});
  room.plug();
  room.camera().picture_error = ENODEV;  // what the first file answers
  std::atomic<bool> goes_on = false;
  std::jthread plugged([&, line = source->info().line] {
    std::this_thread::sleep_for(milliseconds(50));
    room.camera().picture_error = 0;
    for (int i = 0; i < 5000 && !goes_on; ++i) std::this_thread::sleep_for(milliseconds(1));
    if (!goes_on) line->end();
  });
  for (int count = 0; count < 60; ++count) {
    const camera::FramePtr frame = source->next();
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->width, 64);
  }
  goes_on = true;
}

// Another camera at the same plug is not taken for the first one.
TEST(CameraDevice, AnotherCameraIsNotTakenForIt) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(), {60});
  room.plug();
  const auto source = open_source("/dev/video0");
  ASSERT_NE(source->next(), nullptr);
  room.unplug();
  std::snprintf(room.camera().card, sizeof room.camera().card, "Another one");
  room.plug();
  room.camera().picture_error = ENODEV;  // what the first file answers
  std::jthread plugged([&] {
    std::this_thread::sleep_for(milliseconds(50));
    room.camera().picture_error = 0;
  });
  EXPECT_GE(told_after_ms(*source, "another camera is there"), 0);
}

// Pictures that the driver lost are counted and told while others come.
TEST(CameraDevice, TellsThatPicturesAreLost) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(), {100});
  room.plug();
  const auto source = open_source("/dev/video0");
  const std::int64_t first = source->next()->index;
  room.camera().loses = 30;  // 0.3 s: no silence yet
  camera::FramePtr frame = source->next();
  while (frame->index < first + 30) frame = source->next();
  EXPECT_GE(told_after_ms(*source, "pictures were lost: check its cable"), 0);
  EXPECT_EQ(source->info().line->trouble(), "") << "pictures come";
}

// A second reader is refused, and the first goes on: what shows a camera never takes it from the operation.
TEST(CameraDevice, HasOneReader) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_YUYV, clip(), {60});
  room.plug();
  const auto source = open_source("/dev/video0");
  EXPECT_THAT(message_of<DeviceError>([] { (void)open_source("/dev/video0"); }), HasSubstr("is in use"));
  EXPECT_EQ(camera_facts({0}).trouble, "");
  EXPECT_NE(source->next(), nullptr);
}

}  // namespace
}  // namespace arthronaut::sources
