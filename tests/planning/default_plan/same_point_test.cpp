#include "tests/planning/default_plan/same_point.h"

#include <algorithm>

#include "planning/phantom/phantom_knee.h"

namespace arthronaut::test {
namespace {

class SamePoint : public ::testing::TestWithParam<bones::BoneKind> {};

// However a bone lies, of either side, cut off anywhere above or below the joint, and noisy.
TEST_P(SamePoint, HoweverTheBoneLiesAndWhateverOfItIsThere) {
  for (const std::uint32_t seed : {1u, 4u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto knee =
        phantom::make_phantom_knee({.side = bones::Side::Right, .seed = seed, .edge_length_mm = 1.5});
    const auto& bone = GetParam() == bones::BoneKind::Femur ? knee.femur : knee.tibia;
    expect_same_point(spread_of(bone.mesh, GetParam(), seed));
  }
}

// A stump that ends within the condyles tells its axes, or nothing is proposed of it: what its only cut is
// taken for must not turn them.
TEST(FemoralStump, IsNeverTurned) {
  const auto knee =
      phantom::make_phantom_knee({.side = bones::Side::Right, .seed = 4, .edge_length_mm = 1.5});
  const geometry::TriangleMesh& femur = knee.femur.mesh;
  const auto whole = landmarks::propose(femur, bones::BoneKind::Femur);
  ASSERT_TRUE(whole.is_usable());
  const Eigen::Vector3d away = whole.axes.proximal;
  const double low_mm =
      std::ranges::min(femur.vertices_mm, {}, [&](const auto& v) { return v.dot(away); }).dot(away);
  const Eigen::Vector3d middle =
      knee.femur_landmarks.at("lateral_epicondyle") / 2 + knee.femur_landmarks.at("medial_epicondyle") / 2;
  const Eigen::Vector3d at = middle + (low_mm + 45 - middle.dot(away)) * away;
  for (const double azimuth_rad : {0.0, 2.1, 4.2}) {
    const Eigen::Vector3d axis = Eigen::AngleAxisd(azimuth_rad, away) * away.unitOrthogonal();
    const Eigen::Vector3d leaning = Eigen::AngleAxisd(0.3, axis) * away;
    const auto stump = landmarks::propose(cut_off(femur, leaning, at.dot(leaning)), bones::BoneKind::Femur,
                                          {.side = bones::Side::Right});
    if (!stump.is_usable()) continue;
    EXPECT_LT(geometry::deg_from_rad(geometry::angle_between_rad(stump.axes.proximal, away)), 20)
        << azimuth_rad;
  }
}

INSTANTIATE_TEST_SUITE_P(Both, SamePoint, ::testing::Values(bones::BoneKind::Femur, bones::BoneKind::Tibia),
                         [](const auto& test) { return std::string(bones::to_text(test.param)); });

}  // namespace
}  // namespace arthronaut::test
