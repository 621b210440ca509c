#include "navigation/calibration/ruler_sightings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "navigation/camera/medium.h"
#include "navigation/simulator/simulated_ruler.h"
#include "planning/geometry/error.h"

namespace arthronaut::calibration {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

simulator::RulerOptions scene_in(double index) {
  simulator::RulerOptions scene;
  scene.camera = simulator::standard_camera();
  scene.refractive_index = index;
  scene.frame_count = 24;
  return scene;
}

RulerSightingsOptions options_for(const simulator::RulerOptions& scene, double stated_index) {
  RulerSightingsOptions options;
  options.calibration = scene.camera;
  options.refractive_index = stated_index;
  return options;
}

// Between the pixels.
std::uint8_t shown_at(const camera::Frame& frame, const Eigen::Vector2d& at, int channel) {
  const int x = std::clamp(static_cast<int>(at.x()), 0, frame.width - 2);
  const int y = std::clamp(static_cast<int>(at.y()), 0, frame.height - 2);
  const double u = std::clamp(at.x() - x, 0.0, 1.0), v = std::clamp(at.y() - y, 0.0, 1.0);
  const auto value = [&](int dx, int dy) {
    return frame.bgr[static_cast<std::size_t>(3 * ((y + dy) * frame.width + x + dx) + channel)];
  };
  return static_cast<std::uint8_t>(std::lround((1 - v) * ((1 - u) * value(0, 0) + u * value(1, 0)) +
                                               v * ((1 - u) * value(0, 1) + u * value(1, 1))));
}

// Frames of a ruler in saline are taken, with corners to a tenth of a pixel: the true index comes back.
TEST(RulerSightings, TakesTheFramesOfARulerInSaline) {
  const simulator::RulerOptions scene = scene_in(camera::kSalineIndex);
  simulator::SimulatedRuler source(scene);
  RulerSightings sightings(options_for(scene, camera::kSalineIndex));
  while (const camera::FramePtr frame = source.next()) {
    const RulerLook& seen = sightings.look(*frame);
    EXPECT_EQ(seen.is_taken, seen.reason.empty()) << seen.reason;
  }
  EXPECT_EQ(sightings.frame_count(), 24U);
  ASSERT_GE(sightings.sightings().size(), 22U);
  const FluidCheckSummary check = check_fluid(sightings.sightings(), {}, scene.camera, {});
  EXPECT_THAT(check.reasons, IsEmpty());
  EXPECT_NEAR(check.best_index, camera::kSalineIndex, 0.01);
  sightings.clear();
  EXPECT_THAT(sightings.sightings(), IsEmpty());
}

// A port that does not refract, saline stated: the markers are found all the same, so that the check can
// tell.
TEST(RulerSightings, FindsTheMarkersThoughTheStatedMediumIsWrong) {
  const simulator::RulerOptions scene = scene_in(camera::kAirIndex);
  simulator::SimulatedRuler source(scene);
  RulerSightings sightings(options_for(scene, camera::kSalineIndex));
  while (const camera::FramePtr frame = source.next()) sightings.look(*frame);
  ASSERT_GE(sightings.sightings().size(), 20U);
  const FluidCheckSummary check = check_fluid(sightings.sightings(), {}, scene.camera, {});
  EXPECT_FALSE(check.is_trusted());
  EXPECT_EQ(check.rows.front().hypothesis, FluidHypothesis::NoRefraction);
}

// Nothing in the picture: not taken, and said why; enough: said too.
TEST(RulerSightings, SaysWhyAFrameIsNotTaken) {
  const simulator::RulerOptions scene = scene_in(camera::kSalineIndex);
  simulator::SimulatedRuler source(scene);
  RulerSightingsOptions options = options_for(scene, camera::kSalineIndex);
  options.most = 1;
  RulerSightings sightings(options);
  EXPECT_FALSE(RulerLook{}.reason.empty());

  camera::Frame black = *source.next();
  std::fill(black.bgr.begin(), black.bgr.end(), std::uint8_t{0});
  EXPECT_FALSE(sightings.look(black).is_taken);
  EXPECT_THAT(sightings.look(black).reason, HasSubstr("the rim of the view is not seen"));

  for (int i = 0; i < 5 && !sightings.is_full(); ++i) sightings.look(*source.next());
  ASSERT_TRUE(sightings.is_full());
  EXPECT_THAT(sightings.look(*source.next()).reason, HasSubstr("enough"));
  EXPECT_EQ(sightings.sightings().size(), 1U);
}

// A source that hangs on one picture shows one view, whatever its rate, and no check is made of it; that it
// is coded anew does not help.
TEST(RulerSightings, Hazard28AFrozenPictureIsNoCheck) {
  const simulator::RulerOptions scene = scene_in(camera::kSalineIndex);
  for (const int per_second : {30, 120}) {
    simulator::SimulatedRuler source(scene);
    RulerSightings sightings(options_for(scene, camera::kSalineIndex));
    camera::Frame held;
    for (int i = 0; i < 3; ++i) held = *source.next();
    for (int i = 0; i < 41; ++i) {
      held.index = i;
      held.timestamp_ns = static_cast<std::int64_t>(i) * 1'000'000'000 / per_second;
      if (i % 3 == 1) held.bgr[held.bgr.size() / 2] ^= 1;
      sightings.look(held);
    }
    EXPECT_LT(sightings.sightings().size(), 6U) << per_second;
    EXPECT_GE(sightings.sightings().size(), 1U) << per_second;
    EXPECT_FALSE(check_fluid(sightings.sightings(), {}, scene.camera, {}).is_trusted());
    EXPECT_THAT(sightings.look(held).reason, HasSubstr("the picture"));
  }
}

// Another zoom, of which half of the rim is seen: the mark is found, and nothing else tells it.
TEST(RulerSightings, Hazard9APictureOfAnotherZoomIsNotTaken) {
  const simulator::RulerOptions scene = scene_in(camera::kSalineIndex);
  int marks_found = 0;
  for (const int side : {0, 1, 2, 3}) {
    simulator::SimulatedRuler source(scene);
    RulerSightings sightings(options_for(scene, camera::kSalineIndex));
    for (int i = 0; i < 12; ++i) {
      const camera::FramePtr picture = source.next();
      camera::Frame zoomed = *picture;
      const camera::Boundary& rim = scene.camera.boundary;
      constexpr double kZoom = 1.015;
      for (int y = 0; y < zoomed.height; ++y) {
        for (int x = 0; x < zoomed.width; ++x) {
          const Eigen::Vector2d at = Eigen::Vector2d(x, y) - rim.center_px;
          const double across[] = {at.x(), -at.x(), at.y(), -at.y()};
          const bool is_covered = across[side] > 0.2 * rim.radius_px;
          const Eigen::Vector2d from = rim.center_px + at / kZoom;
          for (int channel = 0; channel < 3; ++channel)
            zoomed.bgr[static_cast<std::size_t>(3 * (y * zoomed.width + x) + channel)] =
                is_covered ? 0 : shown_at(*picture, from, channel);
        }
      }
      const RulerLook& seen = sightings.look(zoomed);
      marks_found += seen.lens.mark == lens::MarkState::Found;
      EXPECT_FALSE(seen.is_taken) << side << ", " << i << ": " << lens::to_text(seen.lens.zoom);
    }
  }
  EXPECT_GT(marks_found, 5) << "else nothing was tried";
}

// Broken contracts are named.
TEST(RulerSightings, ThrowsOnBrokenContracts) {
  const simulator::RulerOptions scene = scene_in(camera::kSalineIndex);
  RulerSightingsOptions options = options_for(scene, camera::kSalineIndex);
  camera::Frame small;
  small.width = small.height = 64;
  small.bgr.assign(3 * 64 * 64, 0);
  EXPECT_THROW(RulerSightings(options).look(small), InvalidInput);
  options.ruler.second_id = options.ruler.first_id;
  EXPECT_THROW(RulerSightings{options}, InvalidInput);
  options = options_for(scene, 0.5);
  EXPECT_THROW(RulerSightings{options}, InvalidInput);
}

}  // namespace
}  // namespace arthronaut::calibration
