#include "navigation/calibration/fluid_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "navigation/camera/medium.h"
#include "tests/navigation/calibration/board_scene.h"

namespace arthronaut::calibration {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

// The ruler across the view at many places and lens angles, seen through a port of the given kind.
std::vector<RulerSighting> sightings_in(double index, camera::FluidModel fluid, double corner_sigma_px) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> any(-1, 1);
  const camera::Calibration scope = true_scope();
  const Ruler ruler;
  std::vector<RulerSighting> sightings;
  while (sightings.size() < 60) {
    const double lens_angle_deg = 90 * any(random);
    const camera::CameraModel model(scope, geometry::rad_from_deg(lens_angle_deg), index, fluid);
    geometry::RigidTransform camera_from_first =
        board_pose(22, 35 * std::abs(any(random)), 180 * any(random), 180 * any(random));
    // The printed face looks back at the lens; the ruler's middle, not its first marker, is near the axis.
    camera_from_first.rotation =
        camera_from_first.rotation * Eigen::AngleAxisd(geometry::kPi, Eigen::Vector3d::UnitX());
    camera_from_first.translation_mm -= camera_from_first.rotate({5, 0, 0});
    RulerSighting seen;
    seen.mark_angle_deg = scope.reference_mark_angle_deg + lens_angle_deg;
    bool visible = true;
    for (int marker = 0; marker < 2; ++marker)
      for (std::size_t k = 0; k < 4; ++k) {
        const double h = 0.5 * ruler.size_mm;
        const Eigen::Vector3d corner(k == 0 || k == 3 ? -h : h, k < 2 ? h : -h, 0);
        const auto pixel =
            model.project(camera_from_first * (marker == 0 ? corner : ruler.first_from_second * corner));
        visible = visible && pixel && model.is_inside_view(*pixel);
        if (!visible) break;
        (marker == 0 ? seen.first_px : seen.second_px)[k] =
            *pixel + corner_sigma_px * Eigen::Vector2d(normal(random), normal(random));
      }
    if (visible) sightings.push_back(seen);
  }
  return sightings;
}

// In saline behind a flat port that model fits best, the index is found and the ruler comes out right.
TEST(FluidCheck, TrustsAFlatPortInSaline) {
  const auto sightings = sightings_in(camera::kSalineIndex, camera::FluidModel::FlatPort, 0.1);
  const FluidCheckSummary summary = check_fluid(sightings, {}, true_scope(), {});
  EXPECT_THAT(summary.reasons, IsEmpty());
  EXPECT_EQ(summary.rows.front().hypothesis, FluidHypothesis::FlatPort);
  EXPECT_NEAR(summary.best_index, camera::kSalineIndex, 0.01);
  // 0.1 px on a 2.9 mm marker at 22 mm: such corners give about 0.03 mm and 0.3 degrees.
  EXPECT_LT(summary.rows.front().median_mm, 0.08);
  EXPECT_LT(summary.rows.front().median_deg, 0.6);
}

// The paper's rule, asked about the same frames, is worse and said to be.
TEST(FluidCheck, RanksTheFocalRuleBehind) {
  const auto sightings = sightings_in(camera::kSalineIndex, camera::FluidModel::FlatPort, 0.1);
  const FluidCheckSummary summary = check_fluid(sightings, {}, true_scope(), {});
  ASSERT_EQ(summary.rows.size(), 3U);
  EXPECT_EQ(summary.rows[1].hypothesis, FluidHypothesis::FocalRule);
  EXPECT_GT(summary.rows[1].median_mm, 2 * summary.rows[0].median_mm);
  EXPECT_GT(summary.rows[2].rms_px, summary.rows[1].rms_px);
}

// Corners of which no pose can be made measure nothing, and nothing is not trusted.
TEST(FluidCheck, DoesNotTrustWhatCouldNotBeMeasured) {
  RulerSighting folded;
  folded.first_px.fill({800, 500});
  folded.second_px.fill({1000, 500});
  const FluidCheckSummary summary = check_fluid(std::vector<RulerSighting>(60, folded), {}, true_scope(), {});
  EXPECT_EQ(summary.frame_count, 0U);
  EXPECT_FALSE(summary.is_trusted());
  EXPECT_EQ(summary.index_sigma, -1);
  EXPECT_EQ(summary.shown_index, 0);
}

// A dome port does not refract: told, instead of trusted.
TEST(FluidCheck, NoticesThatNothingIsRefracted) {
  const auto sightings = sightings_in(camera::kAirIndex, camera::FluidModel::FlatPort, 0.1);
  const FluidCheckSummary summary = check_fluid(sightings, {}, true_scope(), {});
  EXPECT_FALSE(summary.is_trusted());
  EXPECT_EQ(summary.rows.front().hypothesis, FluidHypothesis::NoRefraction);
  EXPECT_NEAR(summary.best_index, 1.0, 0.02);
}

// Air stated in saline and saline in air: the first reason names both media, and the shown one is data.
TEST(FluidCheck, Hazard27AWrongMediumIsTheFirstReason) {
  for (const auto& [truth, stated] : {std::pair(camera::kSalineIndex, camera::kAirIndex),
                                      std::pair(camera::kAirIndex, camera::kSalineIndex)}) {
    FluidCheckOptions options;
    options.refractive_index = stated;
    const auto summary =
        check_fluid(sightings_in(truth, camera::FluidModel::FlatPort, 0.1), {}, true_scope(), options);
    EXPECT_EQ(summary.shown_index, truth);
    ASSERT_FALSE(summary.reasons.empty());
    EXPECT_THAT(summary.reasons.front(), HasSubstr("are of " + camera::medium_to_text(truth) + ", not of " +
                                                   camera::medium_to_text(stated)));
  }
  const auto right = check_fluid(sightings_in(camera::kSalineIndex, camera::FluidModel::FlatPort, 0.1), {},
                                 true_scope(), {});
  EXPECT_EQ(right.shown_index, 0);
}

// What the scatter leaves of the index: a little at a tenth of a pixel; with corners 4 px off, too much to
// tell media apart, and said so instead of a wrong index.
TEST(FluidCheck, KnowsHowWellTheIndexIsKnown) {
  const auto sharp = check_fluid(sightings_in(camera::kSalineIndex, camera::FluidModel::FlatPort, 0.1), {},
                                 true_scope(), {});
  EXPECT_GT(sharp.index_sigma, 0);
  EXPECT_LT(sharp.index_sigma, 0.003);
  EXPECT_LT(std::abs(sharp.best_index - camera::kSalineIndex), 4 * sharp.index_sigma);
  const auto coarse =
      check_fluid(sightings_in(camera::kSalineIndex, camera::FluidModel::FlatPort, 4), {}, true_scope(), {});
  EXPECT_THAT(coarse.reasons, Contains(HasSubstr("hardly differ")));
}

// Nothing seen: no verdict but the reason.
TEST(FluidCheck, SaysThatTooLittleWasSeen) {
  EXPECT_THAT(check_fluid({}, {}, true_scope(), {}).reasons, Contains(HasSubstr("0 frames only")));
  EXPECT_FALSE(FluidCheckSummary{}.is_trusted());
}

}  // namespace
}  // namespace arthronaut::calibration
