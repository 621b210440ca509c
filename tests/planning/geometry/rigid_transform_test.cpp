#include "planning/geometry/rigid_transform.h"

#include <gtest/gtest.h>

#include <random>

namespace arthronaut::geometry {
namespace {

Vector6d random_twist(std::mt19937& random, double translation_mm, double rotation_rad) {
  std::normal_distribution<double> normal;
  Vector6d twist;
  for (int i = 0; i < 6; ++i) twist[i] = normal(random);
  twist.head<3>() *= translation_mm;
  twist.tail<3>() = twist.tail<3>().normalized() * rotation_rad;
  return twist;
}

// log undoes exp from the smallest rotations to just below half a turn.
TEST(RigidTransform, LogUndoesExp) {
  std::mt19937 random(1);
  for (const double angle : {0.0, 1e-12, 1e-8, 1e-5, 1e-3, 0.1, 1.0, 3.0, kPi - 1e-4}) {
    for (int i = 0; i < 20; ++i) {
      const Vector6d twist = random_twist(random, 50, angle);
      EXPECT_LT((log(exp(twist)) - twist).norm(), 1e-8) << angle;
    }
  }
}

// The closed form against the power series of the 4 x 4 matrix.
TEST(RigidTransform, ExpIsTheMatrixExponential) {
  std::mt19937 random(2);
  for (const double angle : {1e-6, 0.01, 1.0, 3.0}) {
    const Vector6d twist = random_twist(random, 10, angle);
    Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
    generator.topLeftCorner<3, 3>() = cross_matrix(twist.tail<3>());
    generator.topRightCorner<3, 1>() = twist.head<3>();
    Eigen::Matrix4d sum = Eigen::Matrix4d::Identity(), term = Eigen::Matrix4d::Identity();
    for (int n = 1; n < 60; ++n) {
      term = Eigen::Matrix4d(term * generator / n);
      sum += term;
    }
    const RigidTransform transform = exp(twist);
    EXPECT_LT((transform.matrix() - sum.topLeftCorner<3, 3>()).norm(), 1e-10);
    EXPECT_LT((transform.translation_mm - sum.topRightCorner<3, 1>()).norm(), 1e-9);
  }
}

TEST(RigidTransform, InverseUndoes) {
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform a_from_b = exp(random_twist(random, 100, 2.0));
    const RigidTransform identity = a_from_b * a_from_b.inverse();
    EXPECT_LT(log(identity).norm(), 1e-12);
    const Eigen::Vector3d p(1, -2, 3);
    EXPECT_LT((a_from_b.inverse() * (a_from_b * p) - p).norm(), 1e-12);
  }
}

// (A * B) * p is A * (B * p).
TEST(RigidTransform, CompositionActsFromTheRight) {
  std::mt19937 random(4);
  const RigidTransform a = exp(random_twist(random, 30, 1.0)), b = exp(random_twist(random, 30, 2.0));
  const Eigen::Vector3d p(4, 5, -6);
  EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-12);
  EXPECT_LT((a.rotate(p) - a.matrix() * p).norm(), 1e-12);
}

// T * exp(d) = exp(Ad(T) d) * T: what carries a covariance from one frame to the other.
TEST(RigidTransform, AdjointMovesATwistToTheOtherSide) {
  std::mt19937 random(5);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform t = exp(random_twist(random, 40, 1.5));
    const Vector6d d = random_twist(random, 1, 0.3);
    const RigidTransform left = t * exp(d), right = exp(adjoint(t) * d) * t;
    EXPECT_LT(log(left.inverse() * right).norm(), 1e-10);
  }
}

// acos would lose half the digits at 0 and 180 degrees.
TEST(RigidTransform, AnglesStayExactAtTheEnds) {
  for (const double angle : {1e-9, 1e-4, 1.0, kPi - 1e-4}) {
    const Eigen::Vector3d a = Eigen::Vector3d::UnitX() * 7, b(3 * std::cos(angle), 3 * std::sin(angle), 0);
    EXPECT_NEAR(angle_between_rad(a, b), angle, 1e-12);
    const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()));
    EXPECT_NEAR(rotation_angle_rad(q), angle, 1e-12);
    EXPECT_NEAR(rotation_angle_rad(Eigen::Quaterniond(-q.coeffs())), angle, 1e-12);
  }
  EXPECT_NEAR(deg_from_rad(rad_from_deg(33.0)), 33.0, 1e-12);
}

}  // namespace
}  // namespace arthronaut::geometry
