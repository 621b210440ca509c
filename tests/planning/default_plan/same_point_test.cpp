#include "tests/planning/default_plan/same_point.h"

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

INSTANTIATE_TEST_SUITE_P(Both, SamePoint, ::testing::Values(bones::BoneKind::Femur, bones::BoneKind::Tibia),
                         [](const auto& test) { return std::string(bones::to_text(test.param)); });

}  // namespace
}  // namespace arthronaut::test
