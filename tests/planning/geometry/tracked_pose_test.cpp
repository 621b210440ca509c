#include "planning/geometry/tracked_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace arthronaut::geometry {
namespace {

Vector6d normal_twist(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Vector6d twist;
  for (int i = 0; i < 6; ++i) twist[i] = normal(random);
  return twist;
}

TrackedPose pose_with_covariance(std::mt19937& random, double sigma_mm, double sigma_rad) {
  Vector6d twist = normal_twist(random);
  twist.head<3>() *= 20;
  twist.tail<3>() *= 0.5;
  TrackedPose pose;
  pose.target_from_source = exp(twist);
  pose.timestamp_ns = 1000;
  pose.is_valid = true;
  Matrix6d root = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i)
    root.row(i) = 0.4 * normal_twist(random).transpose() * (i < 3 ? sigma_mm : sigma_rad);
  for (int i = 0; i < 6; ++i) root(i, i) += i < 3 ? sigma_mm : sigma_rad;
  pose.covariance = root * root.transpose();
  return pose;
}

// The predicted covariance against that of samples: what is on the screen as "how wrong may this be".
TEST(TrackedPose, ComposedCovarianceIsThatOfSamples) {
  std::mt19937 random(1);
  // Small, so that first order is all there is; the mm are scaled down as the radians are.
  const TrackedPose a = pose_with_covariance(random, 0.05, 0.001),
                    b = pose_with_covariance(random, 0.05, 0.001);
  const TrackedPose ab = compose(a, b), a_inverse = inverse(a);
  const Matrix6d root_a = a.covariance.llt().matrixL(), root_b = b.covariance.llt().matrixL();
  Matrix6d sampled = Matrix6d::Zero(), sampled_inverse = Matrix6d::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const RigidTransform noisy_a = a.target_from_source * exp(root_a * normal_twist(random));
    const RigidTransform noisy_b = b.target_from_source * exp(root_b * normal_twist(random));
    const Vector6d error = log(ab.target_from_source.inverse() * (noisy_a * noisy_b));
    const Vector6d inverse_error = log(a_inverse.target_from_source.inverse() * noisy_a.inverse());
    sampled += error * error.transpose() / kSamples;
    sampled_inverse += inverse_error * inverse_error.transpose() / kSamples;
  }
  // 20000 samples know a variance to about 1 %; 5 % leaves room for the cross terms.
  EXPECT_LT((sampled - ab.covariance).norm(), 0.05 * ab.covariance.norm());
  EXPECT_LT((sampled_inverse - a_inverse.covariance).norm(), 0.05 * a_inverse.covariance.norm());
}

TEST(TrackedPose, ComposesOnlyWhatIsValidAndOfOneInstant) {
  std::mt19937 random(2);
  const TrackedPose a = pose_with_covariance(random, 0.1, 0.01), b = pose_with_covariance(random, 0.1, 0.01);
  EXPECT_TRUE(compose(a, b).is_valid);
  TrackedPose lost = a;
  lost.is_valid = false;
  EXPECT_FALSE(compose(lost, b).is_valid);
  EXPECT_FALSE(compose(b, lost).is_valid);
  TrackedPose later = b;
  later.timestamp_ns += 1;
  EXPECT_FALSE(compose(a, later).is_valid);
}

// A pose from the future is as unusable as a stale one: both mean that the clocks or the queue are wrong.
TEST(TrackedPose, IsUsableForItsAgeOnly) {
  TrackedPose pose;
  pose.timestamp_ns = 1000;
  EXPECT_FALSE(pose.is_usable_at(1000, 100));
  pose.is_valid = true;
  EXPECT_TRUE(pose.is_usable_at(1000, 100));
  EXPECT_TRUE(pose.is_usable_at(1100, 100));
  EXPECT_FALSE(pose.is_usable_at(1101, 100));
  EXPECT_FALSE(pose.is_usable_at(999, 100));
}

}  // namespace
}  // namespace arthronaut::geometry
