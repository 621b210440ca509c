// The lens tracker on recorded clips with the true mark angle and circle of every frame, and on real
// endoscope frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "navigation/lens/lens_tracker.h"
#include "navigation/sources/frame_source.h"
#include "planning/files/csv_table.h"
#include "planning/geometry/quantile.h"
#include "tests/real_data/real_data.h"

namespace arthronaut {
namespace {

struct ClipErrors {
  std::vector<double> angle_deg, center_px;  // of the frames where the mark was found
  std::size_t frames = 0;
  [[nodiscard]] double found_share() const {
    return static_cast<double>(angle_deg.size()) / static_cast<double>(frames);
  }
};

ClipErrors track(const std::filesystem::path& folder) {
  const files::CsvTable truth = files::CsvTable::read(folder / "gt/lens.csv", {"mark_angle_deg"});
  const auto source = sources::open_video(folder / "clip.mkv");
  lens::LensTracker tracker;
  ClipErrors errors;
  std::vector<std::uint8_t> gray;
  while (const camera::FramePtr frame = source->next()) {
    camera::gray_from(*frame, gray);
    const auto& seen =
        tracker.observe({gray.data(), frame->width, frame->height, frame->width}, frame->timestamp_ns);
    const std::size_t row = errors.frames++;
    if (seen.mark != lens::MarkState::Found) continue;
    errors.angle_deg.push_back(
        std::abs(std::remainder(seen.mark_angle_deg - truth.number(row, "mark_angle_deg"), 360.0)));
    errors.center_px.push_back((seen.circle.center_px - Eigen::Vector2d(truth.number(row, "boundary_x_px"),
                                                                        truth.number(row, "boundary_y_px")))
                                   .norm());
  }
  std::cout << folder.filename().string() << ": mark found in " << errors.angle_deg.size() << " of "
            << errors.frames << " frames, angle error median " << geometry::quantile(errors.angle_deg, 0.5)
            << ", 95 % " << geometry::quantile(errors.angle_deg, 0.95) << " deg, circle centre median "
            << geometry::quantile(errors.center_px, 0.5) << " px\n";
  return errors;
}

class LensOnClips : public testing::TestWithParam<const char*> {};

// Half of what a degree's tenth moves the principal point by is far below a corner's noise; the bounds are
// those that the lens-rotation experiment asks for.
TEST_P(LensOnClips, FollowsTheMark) {
  ARTHRONAUT_REQUIRE_DATA(folder, std::string("arthroscopy/") + GetParam());
  const ClipErrors errors = track(folder);
  ASSERT_GT(errors.frames, 0U);
  EXPECT_GE(errors.found_share(), 0.99);
  EXPECT_LE(geometry::quantile(errors.angle_deg, 0.5), 0.15);
  EXPECT_LE(geometry::quantile(errors.angle_deg, 0.95), 0.5);
  EXPECT_LE(geometry::quantile(errors.center_px, 0.5), 0.3);
}
INSTANTIATE_TEST_SUITE_P(Clips, LensOnClips, testing::Values("ruler_wet", "probe_wet", "guide_wet", "hard"));

// Real frames with a bright tooth that points outwards; circle and angle were measured by hand by somebody
// else.
TEST(LensOnEndoscope, FindsCircleAndToothInEveryFrame) {
  ARTHRONAUT_REQUIRE_DATA(folder, "endoscope/dots-768");
  for (int i = 1; i <= 11; ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%03d.jpg", i);
    const camera::Frame frame = sources::read_picture(folder / name);
    std::vector<std::uint8_t> gray;
    camera::gray_from(frame, gray);
    const lens::LensObservation seen =
        lens::observe_still({gray.data(), frame.width, frame.height, frame.width});
    ASSERT_TRUE(seen.circle_found) << name;
    EXPECT_NEAR((seen.circle.center_px - Eigen::Vector2d(417.7, 341.2)).norm(), 0, 2) << name;
    EXPECT_NEAR(seen.circle.radius_px, 326, 2) << name;
    ASSERT_EQ(seen.mark, lens::MarkState::Found) << name;
    EXPECT_EQ(seen.polarity, lens::MarkPolarity::BrightOutward) << name;
    EXPECT_NEAR(seen.mark_angle_deg, 94.5, 1) << name;
  }
}

}  // namespace
}  // namespace arthronaut
