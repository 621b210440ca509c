#include "navigation/experiments/lens_rotation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::experiments {
namespace {

class LensRotationTest : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const {
    std::ofstream(folder_ / "ruler.json") << text;
    return folder_ / "ruler.json";
  }

  const test::TemporaryFolder folder_;
};

// With a camera calibrated from its own stills, following the lens keeps the relative pose within the paper's
// bar of the product (0.05 mm, 0.2 degrees in the median); not following it, and the paper's rule for the
// fluid, are worse.
TEST_F(LensRotationTest, FollowingTheLensIsWorthIt) {
  const SimulatedLensRotation simulated = simulate_lens_rotation(20, 1);
  const LensRotationResult& result = simulated.result;
  ASSERT_EQ(result.frames.size(), 20u);
  EXPECT_GT(result.rotation_deg, 125);  // 20 frames do not meet the turning points exactly
  const LensModeSummary &following = result.modes[0], &fixed = result.modes[1], &rule = result.modes[2];
  EXPECT_GE(following.frame_count, 19);
  EXPECT_LT(following.median_mm, 0.05);
  EXPECT_LT(following.median_deg, 0.2);
  EXPECT_LT(following.p95_mm, 0.1);
  EXPECT_LT(following.p95_deg, 0.6);
  EXPECT_GT(fixed.median_mm, 3 * following.median_mm);
  EXPECT_GT(rule.median_deg, 3 * following.median_deg);

  write_lens_rotation_plot(folder_ / "plot.png", result, "Lens rotation");
  write_lens_rotation_table(folder_ / "table.csv", result);
  EXPECT_GT(std::filesystem::file_size(folder_ / "plot.png"), 1000u);
  std::ifstream table(folder_ / "table.csv");
  EXPECT_EQ(std::count(std::istreambuf_iterator<char>(table), {}, '\n'), 21);
}

// The truth of a recorded ruler is read as it stands.
TEST_F(LensRotationTest, ReadsARuler) {
  const RulerInFluid seen = read_ruler_file(write(R"({"format": "arthronaut-acceptance.ruler", "version": 1,
      "markers": [7, 9], "size_mm": 3.5, "medium": "water",
      "marker7_from_marker9": {"q_wxyz": [1, 0, 0, 0], "t_mm": [0, 12, 0]}})"));
  const calibration::Ruler& ruler = seen.ruler;
  EXPECT_EQ(ruler.first_id, 7);
  EXPECT_EQ(ruler.second_id, 9);
  EXPECT_EQ(ruler.size_mm, 3.5);
  EXPECT_EQ(seen.refractive_index, 1.333);
  EXPECT_EQ(ruler.first_from_second.translation_mm, Eigen::Vector3d(0, 12, 0));
}

// A ruler with three markers, or without the pose between its two, is refused.
TEST_F(LensRotationTest, RefusesABrokenRuler) {
  EXPECT_THROW((void)read_ruler_file(write(R"({"format": "arthronaut-acceptance.ruler", "version": 1,
      "markers": [5, 6, 7], "size_mm": 3.5, "medium": "water"})")),
               InvalidInput);
  EXPECT_THROW((void)read_ruler_file(write(R"({"format": "arthronaut-acceptance.ruler", "version": 1,
      "markers": [5, 6], "size_mm": 3.5, "medium": "water"})")),
               InvalidInput);
}

}  // namespace
}  // namespace arthronaut::experiments
