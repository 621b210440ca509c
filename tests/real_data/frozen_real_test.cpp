// Frozen pictures and zoom on recorded clips: none of them is frozen, all of them show their rim; a picture
// of theirs that is shown on is frozen.
#include <gtest/gtest.h>

#include <iostream>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "navigation/camera/camera_file.h"
#include "navigation/lens/lens_tracker.h"
#include "navigation/pipeline/frozen_picture.h"
#include "navigation/sources/frame_source.h"
#include "tests/real_data/real_data.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

class FrozenOnClips : public testing::TestWithParam<const char*> {};

// No false alarm: neither of a frozen picture nor of a zoom that is not known.
TEST_P(FrozenOnClips, NoFrameIsFrozenAndTheZoomIsKnown) {
  ARTHRONAUT_REQUIRE_DATA(folder, std::string("arthroscopy/") + GetParam());
  const auto source = sources::open_video(folder / "clip.mkv");
  lens::LensTracker lens({.calibration = camera::read_camera_file(folder / "camera.json").calibration});
  pipeline::FrozenPicture frozen(0.3);
  std::vector<std::uint8_t> gray;
  int frozen_frames = 0, unknown = 0, frames = 0;
  double least_ratio = 10, most_ratio = 0;
  while (const camera::FramePtr frame = source->next()) {
    camera::gray_from(*frame, gray);
    const camera::GrayView picture{gray.data(), frame->width, frame->height, frame->width};
    frozen_frames += frozen.observe(picture, frame->timestamp_ns) ? 1 : 0;
    const lens::LensObservation& seen = lens.observe(picture, frame->timestamp_ns);
    unknown += seen.zoom == lens::ZoomState::AsCalibrated ? 0 : 1;
    least_ratio = std::min(least_ratio, seen.radius_ratio);
    most_ratio = std::max(most_ratio, seen.radius_ratio);
    ++frames;
  }
  std::cout << GetParam() << ": " << frames << " frames, noise " << frozen.noise() << ", radius "
            << least_ratio << " to " << most_ratio << " of the calibrated\n";
  EXPECT_GT(frames, 0);
  EXPECT_EQ(frozen_frames, 0);
  EXPECT_EQ(unknown, 0);
}

// Its twentieth picture, shown on for three seconds and coded anew.
TEST_P(FrozenOnClips, APictureThatIsShownOnIsFrozenWithin300Ms) {
  ARTHRONAUT_REQUIRE_DATA(folder, std::string("arthroscopy/") + GetParam());
  constexpr int kLive = 20, kAll = 200;
  const test::TemporaryFolder temporary;
  const std::string file = (temporary / "v.mkv").string();
  {
    const auto source = sources::open_video(folder / "clip.mkv");
    cv::VideoWriter writer(file, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('a', 'v', 'c', '1'), 60,
                           {source->info().image_size_px.x(), source->info().image_size_px.y()});
    ASSERT_TRUE(writer.isOpened());
    camera::FramePtr frame;
    for (int i = 0; i < kAll; ++i) {
      if (i <= kLive) frame = source->next();
      writer.write(
          cv::Mat(frame->height, frame->width, CV_8UC3, const_cast<std::uint8_t*>(frame->bgr.data())));
    }
  }
  pipeline::FrozenPicture frozen(0.3);
  std::vector<std::uint8_t> gray;
  int false_alarms = 0, missed = 0;
  const auto source = sources::open_video(file);
  while (const camera::FramePtr frame = source->next()) {
    camera::gray_from(*frame, gray);
    const bool is_frozen =
        frozen.observe({gray.data(), frame->width, frame->height, frame->width}, frame->timestamp_ns);
    if (frame->index <= kLive)
      false_alarms += is_frozen ? 1 : 0;
    else if (frame->index >= kLive + 18)
      missed += is_frozen ? 0 : 1;
  }
  EXPECT_EQ(false_alarms, 0);
  EXPECT_EQ(missed, 0);
}

INSTANTIATE_TEST_SUITE_P(Arthroscopy, FrozenOnClips,
                         testing::Values("probe_wet", "guide_wet", "ruler_wet", "hard"),
                         [](const auto& clip) { return std::string(clip.param); });

}  // namespace
}  // namespace arthronaut
