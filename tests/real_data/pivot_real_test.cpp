#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "navigation/tools/pivot_calibration.h"
#include "tests/real_data/real_data.h"

namespace arthronaut::tools {
namespace {

std::vector<geometry::RigidTransform> read_matrices(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".txt" && std::isdigit(entry.path().filename().string()[0])) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());  // the names are the times
  std::vector<geometry::RigidTransform> poses;
  for (const auto& file : files) {
    std::ifstream in(file);
    Eigen::Matrix4d matrix;
    for (int i = 0; i < 16; ++i) in >> matrix(i / 4, i % 4);
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    poses.push_back({Eigen::Quaterniond(rotation).normalized(), matrix.topRightCorner<3, 1>()});
  }
  return poses;
}

// A pointer of 394 mm before an optical tracker 2 m away, with poses that don't fit; all poses by least
// squares give
// (-14.5, 394.6, -7.4) mm and 3.05 mm RMS. The tip's own one-sigma is 1.0 mm here (17 deg of cone, 2 mm of
// noise), so two estimates of it may differ by 3 mm; and a pointer known to 1 mm must not be called reliable.
TEST(RealPivot, FindsTheTipDespiteOutliersAndRefusesIt) {
  ARTHRONAUT_REQUIRE_DATA(folder, "pivot");
  const auto poses = read_matrices(folder);
  ASSERT_EQ(poses.size(), 57u);
  const auto summary = calibrate_pivot(poses);
  ASSERT_TRUE(summary.has_tip());
  const Eigen::Vector3d tip = summary.tip_in_tool_mm;
  std::printf(
      "tip %.2f, %.2f, %.2f mm; rms %.2f mm on %d of %d poses (%d outliers); cone %.1f deg; sigma %.2f mm\n",
      tip.x(), tip.y(), tip.z(), summary.rms_mm, summary.inlier_count, summary.pose_count,
      summary.pose_count - summary.inlier_count, summary.cone_deg, summary.sigma_mm);
  EXPECT_LT((tip - Eigen::Vector3d(-14.5, 394.6, -7.4)).norm(), 3.0);
  EXPECT_LT(summary.rms_mm, 2.5);
  EXPECT_GE(summary.pose_count - summary.inlier_count, 3);
  EXPECT_LE(summary.pose_count - summary.inlier_count, 8);
  EXPECT_FALSE(summary.is_usable());
  EXPECT_EQ(summary.outcome, PivotCalibrationSummary::Outcome::ConeTooNarrow);
}

}  // namespace
}  // namespace arthronaut::tools
