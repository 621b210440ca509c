// What of a picture stands, by pictures of a round view whose truth is known.
#include "navigation/pipeline/view_tracker.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/navigation/lens/rim_picture.h"
#include "tests/navigation/pipeline/scripted_markers.h"

namespace arthronaut::pipeline {
namespace {

camera::Frame frame_of(const lens::RimTruth& truth, std::int64_t index) {
  const lens::RimPicture picture = lens::draw(truth);
  camera::Frame frame;
  frame.index = index;
  frame.timestamp_ns = index * 1'000'000'000 / 60;
  frame.width = truth.width;
  frame.height = truth.height;
  frame.bgr.reserve(3 * picture.gray.size());
  for (const std::uint8_t grey : picture.gray) frame.bgr.insert(frame.bgr.end(), 3, grey);
  return frame;
}

// A hand turns the lens by ten degrees in a tenth of a second: without its mark the angle is only held for as
// long as it can't have led the principal point far away, and that is much less than the second after which
// nothing at all is known. A scope whose principal point lies on the axis that the lens turns about loses
// nothing.
TEST(ViewTracker, TheAngleOfAMarkThatIsNotSeenHoldsAsLongAsItIsSure) {
  for (const double beside_px : {30.0, 0.0}) {
    lens::RimTruth truth;
    ViewTrackerOptions options;
    camera::Calibration& calibration = options.calibration;
    calibration = test::small_calibration();
    calibration.image_size_px = {truth.width, truth.height};
    calibration.focal_px = 250;
    calibration.rotation_center_px = truth.center_px;
    calibration.principal_point_px = truth.center_px + Eigen::Vector2d(beside_px, 0);
    calibration.boundary = {truth.center_px, truth.radius_px};
    calibration.reference_mark_angle_deg = truth.mark_angle_deg;
    std::vector<markers::MarkerObservation> script{test::seen(0, {})};
    ViewTracker tracker(options, std::make_unique<test::ScriptedMarkers>(&script));
    PictureObservation view;
    std::int64_t index = 0;
    const auto show = [&] {
      truth.seed = static_cast<unsigned>(index);
      tracker.observe(frame_of(truth, index++), view);
    };
    for (int i = 0; i < 20; ++i) show();
    ASSERT_EQ(view.lens.mark, lens::MarkState::Found);
    EXPECT_TRUE(view.intrinsics_are_known);
    truth.has_mark = false;
    show();
    ASSERT_NE(view.lens.mark, lens::MarkState::Found);
    EXPECT_TRUE(view.intrinsics_are_known) << "one picture is soon over";
    for (int i = 0; i < 11; ++i) show();
    EXPECT_FALSE(view.lens.is_stale);
    EXPECT_EQ(view.intrinsics_are_known, beside_px == 0) << view.lens.mark_sigma_deg << " degrees";
    truth.has_mark = true;
    for (int i = 0; i < 3; ++i) show();
    ASSERT_EQ(view.lens.mark, lens::MarkState::Found);
    EXPECT_TRUE(view.intrinsics_are_known);
  }
}

}  // namespace
}  // namespace arthronaut::pipeline
