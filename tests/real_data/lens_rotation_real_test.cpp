#include <gtest/gtest.h>

#include "navigation/camera/camera_file.h"
#include "navigation/experiments/lens_rotation.h"
#include "tests/real_data/real_data.h"

namespace arthronaut::experiments {
namespace {

// The paper's experiment on the path-traced ruler, with the true camera: within the product's bar of 0.2
// degrees and 0.05 mm in the median, 0.6 degrees and 0.1 mm in 95 % of the frames.
TEST(RealLensRotation, KeepsTheRulerWhileTheLensTurns) {
  ARTHRONAUT_REQUIRE_DATA(set, "arthroscopy/ruler_wet");
  const auto source = sources::open_video(set / "clip.mkv");
  const auto result = run_lens_rotation(*source, camera::read_camera_file(set / "camera.json").calibration,
                                        read_ruler_file(set / "gt" / "ruler.json"));
  for (std::size_t i = 0; i < kLensModes.size(); ++i) {
    const LensModeSummary& mode = result.modes[i];
    std::printf("%-20s %d frames, %.3f mm (95 %%: %.3f), %.3f deg (95 %%: %.3f)\n",
                std::string(to_text(kLensModes[i])).c_str(), mode.frame_count, mode.median_mm, mode.p95_mm,
                mode.median_deg, mode.p95_deg);
  }
  EXPECT_GE(result.modes[0].frame_count, 59);
  EXPECT_LE(result.modes[0].median_mm, 0.05);
  EXPECT_LE(result.modes[0].p95_mm, 0.1);
  EXPECT_LE(result.modes[0].median_deg, 0.2);
  EXPECT_LE(result.modes[0].p95_deg, 0.6);
}

}  // namespace
}  // namespace arthronaut::experiments
