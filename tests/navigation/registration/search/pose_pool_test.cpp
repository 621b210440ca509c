#include "navigation/registration/search/pose_pool.h"

#include <gtest/gtest.h>

#include "tests/navigation/registration/phantom_bone.h"

namespace arthronaut::registration {

// A pose that two searches came to is one pose, found twice; what one of them brought beside it is a rival.
TEST(PosePool, CountsTheSearchesThatCameToTheBestPose) {
  const PhantomBone& bone = phantom_bone();
  const auto trial = bone.trial(experiments::TrialNoise::Dry, 1);
  const WeightedPoints points = choose_points(trial.curves, 800);
  PosePool pool(bone.prepared->data(), {});
  EXPECT_EQ(pool.best_find_count(), 0);
  Hypothesis near{trial.marker_from_bone.inverse(), 1}, far = near;
  near.bone_from_marker.translation_mm.x() += 0.8;
  far.bone_from_marker.translation_mm.z() += 30;
  pool.add({near, far}, points, 1);
  EXPECT_EQ(pool.best_find_count(), 1);
  near.bone_from_marker.translation_mm.y() -= 1.1;
  pool.add({near}, points, 2);
  EXPECT_EQ(pool.best_find_count(), 2);
  pool.refine_all(points, 5);
  EXPECT_EQ(pool.best_find_count(), 2);
  pool.add({far}, points, 3);
  EXPECT_EQ(pool.best_find_count(), 2);
  EXPECT_LT(
      (pool.best().bone_from_marker.inverse() * bone.target_mm - trial.marker_from_bone * bone.target_mm)
          .norm(),
      0.4);
}

// Of more hypotheses than are refined, the right one is among those that are, however its score ranks.
TEST(PosePool, LetsManyHypothesesCompete) {
  const PhantomBone& bone = phantom_bone();
  const auto trial = bone.trial(experiments::TrialNoise::ExVivo, 1);
  const WeightedPoints points = choose_points(trial.curves, 800, strokes::oriented_points(trial.curves));
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 100; ++i) {
    hypotheses.push_back({trial.marker_from_bone.inverse(), 1});
    geometry::RigidTransform& pose = hypotheses.back().bone_from_marker;
    if (i == 99) {
      pose.translation_mm += Eigen::Vector3d(1, -1, 1);
    } else {
      pose.rotation =
          Eigen::AngleAxisd(0.5 + 0.02 * i, Eigen::Vector3d(1, i % 7 - 3, i % 3 - 1).normalized()) *
          pose.rotation;
    }
  }
  PosePool pool(bone.prepared->data(), {});
  pool.add(hypotheses, points, 1);
  EXPECT_LT(
      (pool.best().bone_from_marker.inverse() * bone.target_mm - trial.marker_from_bone * bone.target_mm)
          .norm(),
      1.0);
}

}  // namespace arthronaut::registration
