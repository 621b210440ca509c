#include "navigation/strokes/packed_optional.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "navigation/strokes/curves.h"

namespace arthronaut::strokes {
namespace {

// What may be missing takes no room of its own, a number and a vector alike.
TEST(PackedOptional, TakesTheRoomOfItsValue) {
  EXPECT_EQ(sizeof(PackedOptional<double>), sizeof(double));
  EXPECT_EQ(sizeof(PackedOptional<Eigen::Vector3d>), sizeof(Eigen::Vector3d));
  EXPECT_EQ(sizeof(CurvePoint), 64U);
}

// It says of itself what a std::optional does, and turns into one and back without a change.
TEST(PackedOptional, ReadsAsAnOptional) {
  PackedOptional<double> time_s;
  EXPECT_FALSE(time_s);
  EXPECT_EQ(time_s.value_or(7), 7);
  const std::optional<double> unpacked_time_s = time_s;
  EXPECT_EQ(unpacked_time_s, std::nullopt);
  EXPECT_EQ(time_s, PackedOptional<double>());
  time_s = 0.0;
  EXPECT_TRUE(time_s.has_value()) << "nothing is not 0";
  EXPECT_EQ(time_s.value_or(7), 0);
  EXPECT_FALSE(time_s == PackedOptional<double>());
  time_s = std::nullopt;
  EXPECT_FALSE(time_s.has_value());

  const std::optional<Eigen::Vector3d> none, some(Eigen::Vector3d(0.1, -2, 3e-9));
  EXPECT_FALSE(PackedOptional<Eigen::Vector3d>(none).has_value());
  const PackedOptional<Eigen::Vector3d> packed(some);
  const std::optional<Eigen::Vector3d> unpacked = packed;
  EXPECT_EQ(unpacked, some);
  EXPECT_EQ(packed->z(), 3e-9);
}

}  // namespace
}  // namespace arthronaut::strokes
