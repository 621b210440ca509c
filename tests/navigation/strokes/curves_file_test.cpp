#include <gtest/gtest.h>

#include <fstream>

#include "navigation/strokes/curves.h"
#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::strokes {

// Points come back in order, with their curve and with or without a time.
TEST(CurvesFile, RoundTripKeepsOrderAndEmptyTimes) {
  const Curves curves{{0, 0.25, {1, 2, 3}}, {0, std::nullopt, {-1.5, 2.25, 3}}, {7, 1.0, {0, 0, -9.125}}};
  const test::TemporaryFolder folder;
  const auto file = folder / "curves.csv";
  write_curves_file(file, curves);
  const Curves read = read_curves_file(file);
  ASSERT_EQ(read.size(), curves.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].curve, curves[i].curve);
    EXPECT_EQ(read[i].time_s, curves[i].time_s);
    EXPECT_LT((read[i].position_mm - curves[i].position_mm).norm(), 1e-6);
  }
}

// The way the probe came is written when asked for, with empty cells where it is not known; a plain file has
// none.
TEST(CurvesFile, ShaftsAreWrittenWhenAskedFor) {
  const Eigen::Vector3d shaft = Eigen::Vector3d(1, -2, 0.5).normalized();
  const Curves curves{{0, 0.25, {1, 2, 3}, shaft}, {0, 0.5, {2, 2, 3}, std::nullopt}};
  const test::TemporaryFolder folder;
  const auto file = folder / "curves.csv";
  write_curves_file(file, curves, ShaftColumns::Write);
  const Curves read = read_curves_file(file);
  ASSERT_EQ(read.size(), 2u);
  ASSERT_TRUE(read[0].shaft_direction.has_value());
  EXPECT_LT((*read[0].shaft_direction - shaft).norm(), 1e-5);
  EXPECT_FALSE(read[1].shaft_direction.has_value());
  write_curves_file(file, curves);
  EXPECT_FALSE(read_curves_file(file)[0].shaft_direction.has_value());
}

// A direction has length 1, and all of its numbers.
TEST(CurvesFile, RefusesShaftsThatAreNoDirections) {
  const test::TemporaryFolder folder;
  const auto file = folder / "curves.csv";
  for (const char* cells : {"0.5,0.5,0", "1,0,", "0,0,0"}) {
    std::ofstream(file) << "curve,time_s,x_mm,y_mm,z_mm,shaft_x,shaft_y,shaft_z\n0,0,1,2,3," << cells << "\n";
    EXPECT_THROW((void)read_curves_file(file), InvalidInput) << cells;
  }
}

// Nor one that no hand can reach, which would spread the points over an infinite distance.
TEST(CurvesFile, RefusesPointsMoreThanAMetreAway) {
  const test::TemporaryFolder folder;
  const auto file = folder / "curves.csv";
  for (const char* far : {"1e308", "-1000.5"}) {
    std::ofstream(file) << "curve,time_s,x_mm,y_mm,z_mm\n0,0,1," << far << ",3\n";
    EXPECT_THROW((void)read_curves_file(file), InvalidInput) << far;
  }
}

// A number that is not finite is refused.
TEST(CurvesFile, RefusesNumbersThatAreNotFinite) {
  const test::TemporaryFolder folder;
  const auto file = folder / "curves.csv";
  std::ofstream(file) << "curve,time_s,x_mm,y_mm,z_mm\n0,0,1,inf,3\n";
  EXPECT_THROW((void)read_curves_file(file), InvalidInput);
}

}  // namespace arthronaut::strokes
