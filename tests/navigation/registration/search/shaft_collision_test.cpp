#include "navigation/registration/search/shaft_collision.h"

#include <gtest/gtest.h>

#include "navigation/registration/search/cartilage_offset.h"
#include "tests/navigation/registration/phantom_bone.h"

namespace arthronaut::registration {

namespace {

using experiments::TrialNoise;

// The probe comes in through a medial portal, the knee bent far, as the drill does: from there every touched
// point is reached.
strokes::Curves with_shafts(const PhantomBone& bone, const experiments::Trial& trial, double sign = 1) {
  const Eigen::Vector3d portal_mm = bone.target_mm + 60 * Eigen::Vector3d(0.7, 0.4, -0.6);  // LPS
  strokes::Curves curves = trial.curves;
  for (strokes::CurvePoint& point : curves) {
    const Eigen::Vector3d tip_in_bone_mm = trial.marker_from_bone.inverse() * point.position_mm;
    const Eigen::Vector3d to_portal = (portal_mm - tip_in_bone_mm).normalized();
    point.shaft_direction = Eigen::Vector3d(sign * trial.marker_from_bone.rotate(to_portal));
  }
  return curves;
}

double share_at_truth(const PhantomBone& bone, const experiments::Trial& trial,
                      const strokes::Curves& curves) {
  const geometry::RigidTransform truth = trial.marker_from_bone.inverse();
  return ShaftCollision(bone.prepared->data(), choose_points(curves, 800))
      .share_through_bone(truth.matrix().cast<float>(), truth.translation_mm.cast<float>());
}

}  // namespace

// Through the portal the way is free but for strokes that go round the notch's edge, out of its sight; the
// other way round it leads through the bone but for those.
TEST(ShaftCollision, TellsTheFreeWayFromTheOneThroughTheBone) {
  const PhantomBone& bone = phantom_bone();
  const auto trial = bone.trial(TrialNoise::Dry, 1);
  EXPECT_LT(share_at_truth(bone, trial, with_shafts(bone, trial)), 0.25);
  EXPECT_GT(share_at_truth(bone, trial, with_shafts(bone, trial, -1)), 0.6);
}

// Where the shaft is not known nothing is ruled out.
TEST(ShaftCollision, EveryPoseIsPossibleWithoutShafts) {
  const PhantomBone& bone = phantom_bone();
  const auto trial = bone.trial(TrialNoise::Dry, 1);
  const ShaftCollision way(bone.prepared->data(), choose_points(trial.curves, 800));
  EXPECT_EQ(way.share_through_bone(Eigen::Matrix3f::Identity(), bone.target_mm.cast<float>()), 0);
  EXPECT_TRUE(way.is_possible(Eigen::Matrix3f::Identity(), bone.target_mm.cast<float>()));
}

// The right pose is found with the shafts as without them.
TEST(ShaftCollision, RightPosesStayPossible) {
  const PhantomBone& bone = phantom_bone();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto trial = bone.trial(TrialNoise::Dry, seed);
    const auto found =
        register_curves(*bone.prepared, with_shafts(bone, trial), {seed, false, bone.target_mm});
    EXPECT_TRUE(found.reliable) << testing::PrintToString(found.reasons);
    EXPECT_LT((found.marker_from_bone * bone.target_mm - trial.marker_from_bone * bone.target_mm).norm(),
              0.4);
  }
}

// A probe whose tip is declared at the wrong end: the right pose would lead it through the bone, and no other
// one stands.
TEST(ShaftCollision, RefusesPosesThatLeadTheProbeThroughTheBone) {
  const PhantomBone& bone = phantom_bone();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto trial = bone.trial(TrialNoise::Dry, seed);
    const auto found =
        register_curves(*bone.prepared, with_shafts(bone, trial, -1), {seed, true, bone.target_mm});
    EXPECT_FALSE(found.reliable) << "seed " << seed;
    EXPECT_FALSE(found.reasons.empty());
  }
}

// What is kept where a hardly touched region is left out keeps its shafts.
TEST(ShaftCollision, IsAskedOfWhatIsKeptWhereCartilageIsLeftOut) {
  const PhantomBone& bone = phantom_bone();
  const CartilageTrial laid = cartilage_trial(bone, bone.trial(TrialNoise::Dry, 2), -2, 15);
  const WeightedPoints points = choose_points(with_shafts(bone, laid.trial, -1), 800);
  const geometry::RigidTransform truth = laid.trial.marker_from_bone.inverse();
  PosePool pool(bone.prepared->data(), {});
  pool.add({{truth, 1}}, points, 1);
  const CartilageMap map(bone.prepared->data(), laid.region);
  const MarkerPrior prior;
  const CartilageFit fit = CartilageFitter(bone.prepared->data(), map, prior).fit(pool, points, true);
  ASSERT_TRUE(fit.is_left_out);
  EXPECT_FALSE(ShaftCollision(bone.prepared->data(), fit.points)
                   .is_possible(truth.matrix().cast<float>(), truth.translation_mm.cast<float>()));
}

}  // namespace arthronaut::registration
