#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "tests/navigation/sources/cut_file.h"
#include "tests/real_data/real_data.h"
#include "tests/temporary_folder.h"

namespace arthronaut::sources {
namespace {

// The clip's 240 frames come with their times, 1/60 s apart although Matroska counts in ms.
TEST(RealSources, DecodesTheProbeClip) {
  ARTHRONAUT_REQUIRE_DATA(clip, "arthroscopy/probe_wet/clip.mkv");
  const auto source = open_video(clip);
  EXPECT_EQ(source->info().image_size_px, Eigen::Vector2i(1920, 1080));
  EXPECT_NEAR(source->info().frames_per_second, 60, 1e-9);
  int frames = 0;
  while (const camera::FramePtr frame = source->next()) {
    EXPECT_EQ(frame->index, frames);
    EXPECT_NEAR(static_cast<double>(frame->timestamp_ns), frames * 1e9 / 60, 1.0);
    ++frames;
  }
  EXPECT_EQ(frames, 240);
}

// Half of the clip plays to where it breaks off and then says so.
TEST(RealSources, TellsWhereHalfAClipBreaksOff) {
  ARTHRONAUT_REQUIRE_DATA(clip, "arthroscopy/guide_wet/clip.mkv");
  const test::TemporaryFolder folder;
  copy_beginning(clip, folder / "half.mkv", 0.5);
  const auto source = open_video(folder / "half.mkv");
  int frames = 0;
  std::string message;
  try {
    while (source->next()) ++frames;
  } catch (const InvalidInput& error) {
    message = error.what();
  }
  EXPECT_GT(frames, 5);
  EXPECT_LT(frames, 40);
  EXPECT_NE(message.find("frame " + std::to_string(frames)), std::string::npos) << message;
}

// Stills of the calibration set open as a pattern.
TEST(RealSources, OpensTheCalibrationStills) {
  ARTHRONAUT_REQUIRE_DATA(folder, "arthroscopy/cal_air");
  EXPECT_EQ(open_video(folder / "cal_%d.png")->info().frame_count, 3);
}

}  // namespace
}  // namespace arthronaut::sources
