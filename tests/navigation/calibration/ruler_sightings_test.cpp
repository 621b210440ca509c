#include "navigation/calibration/ruler_sightings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
