// Bones of the plan found in a CT in which they were put: where, and what is refused.
#include "planning/postop/bone_pose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/phantom/phantom_knee.h"
#include "tests/planning/postop/postop_ct.h"

namespace arthronaut::postop {
namespace {

using geometry::RigidTransform;
using testing::HasSubstr;

const phantom::PhantomKnee& knee() {
  static const auto made = phantom::make_phantom_knee({.edge_length_mm = 2});
  return made;
}

FoundBone found_in(const images::Volume& volume, const phantom::PhantomKnee& sought, bones::BoneKind kind) {
  const bool is_femur = kind == bones::BoneKind::Femur;
  const images::VolumeSampler sampler(volume);
  return find_bone(sampler, bone_field(volume, 200).value(), (is_femur ? sought.femur : sought.tibia).mesh,
                   (is_femur ? sought.femoral_tunnel : sought.tibial_tunnel).entry_mm);
}

double off_mm(const FoundBone& found, const RigidTransform& truth, const Eigen::Vector3d& p_in_plan) {
  return (found.pose.postop_from_plan * p_in_plan - truth * p_in_plan).norm();
}

class AnyLie : public ::testing::TestWithParam<double> {};

// Whichever way the patient lay, beside the other bone and with a hole in it: a tenth of a voxel.
TEST_P(AnyLie, BothBonesAreFound) {
  const RigidTransform truth = test::lying(GetParam(), {1, 2, 3}, {30, -20, 60});
  const auto volume = test::postop_ct({knee().femur.mesh, knee().tibia.mesh},
                                      {{.tunnel = knee().femoral_tunnel}}, truth, test::half_fine());
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    const FoundBone found = found_in(volume, knee(), kind);
    EXPECT_TRUE(found.reliable) << testing::PrintToString(found.reasons);
    for (const Eigen::Vector3d& p : {knee().femoral_tunnel.entry_mm, Eigen::Vector3d(40, 0, 20)})
      EXPECT_LT(off_mm(found, truth, p), 0.06);
    EXPECT_GT(found.pose.on_edge_share, 0.97);
  }
}
INSTANTIATE_TEST_SUITE_P(Turns, AnyLie, ::testing::Values(0, 35, 170));

// The femur with a cortex that is thin on both sides and thick in front and behind: through the blur its
// edges lie further out where it is thin, as if the bone were broader than it was.
images::Volume with_uneven_cortex(const RigidTransform& truth) {
  const geometry::TriangleMesh& femur = knee().femur.mesh;
  const geometry::Surface surface(femur);
  const RigidTransform plan_from_postop = truth.inverse();
  const Eigen::Vector3d middle = geometry::bounds_of(femur).center_mm();
  test::KnownCtOptions options = test::half_fine();
  options.blur_mm = 0.5;
  options.operate = [&](images::Volume& volume) {
    constexpr double kThin_mm = 0.6, kAside_mm = 22;
    std::size_t v = 0;
    for (int k = 0; k < volume.size.z(); ++k)
      for (int j = 0; j < volume.size.y(); ++j)
        for (int i = 0; i < volume.size.x(); ++i, ++v) {
          if (volume.values[v] < 1100) continue;
          const Eigen::Vector3d p = plan_from_postop * (volume.lps_from_index * Eigen::Vector3d(i, j, k));
          if (std::abs(p.x() - middle.x()) > kAside_mm &&
              (surface.closest_point(p).point_mm - p).norm() > kThin_mm)
            volume.values[v] = static_cast<float>(options.marrow_hu);
        }
  };
  return test::postop_ct({femur}, {}, truth, options);
}

// It is the patient's all the same. One that is broader or narrower by a hundredth is not, which such a
// cortex hides, or makes look wrong the other way round.
TEST(BonePose, AnUnevenCortexIsNoOtherBoneAndHidesNone) {
  const RigidTransform truth = test::lying(20, {1, 2, 3}, {30, -20, 60});
  const images::Volume volume = with_uneven_cortex(truth);
  const FoundBone found = found_in(volume, knee(), bones::BoneKind::Femur);
  EXPECT_TRUE(found.reliable) << testing::PrintToString(found.reasons);
  EXPECT_LT(off_mm(found, truth, knee().femoral_tunnel.entry_mm), 0.15);
  for (const double broader : {0.99, 1.01}) {
    auto other = knee();
    for (Eigen::Vector3d& p : other.femur.mesh.vertices_mm) p.x() *= broader;
    const FoundBone refused = found_in(volume, other, bones::BoneKind::Femur);
    EXPECT_NEAR(refused.pose.stretch, 0.01, 0.002) << broader;
    EXPECT_THAT(refused.reasons, testing::Contains(HasSubstr("longer or shorter"))) << broader;
  }
}

// Blur rounds the plateau's edge, as if the bone were narrower than it was: it is the patient's all the same,
// and one that is narrower or lower by a hundredth is not.
TEST(BonePose, ABlurThatRoundsItsEdgesIsNoOtherBone) {
  const RigidTransform truth = test::lying(20, {1, 2, 3}, {30, -20, 60});
  test::KnownCtOptions options = test::half_fine();
  options.blur_mm = 0.8;
  const auto volume = test::postop_ct({knee().tibia.mesh}, {}, truth, options);
  const FoundBone found = found_in(volume, knee(), bones::BoneKind::Tibia);
  EXPECT_TRUE(found.reliable) << testing::PrintToString(found.reasons);
  EXPECT_LT(found.pose.stretch, 0.003);
  auto other = knee();
  for (Eigen::Vector3d& p : other.tibia.mesh.vertices_mm) p *= 1.01;
  EXPECT_FALSE(found_in(volume, other, bones::BoneKind::Tibia).reliable);
}

// Other knees, so much alike that nearly all of their surface lies within 1 mm of this one's; and the other
// side's.
TEST(BonePose, AnotherPatientsBoneIsNotReliable) {
  const RigidTransform truth = test::lying(20, {1, 2, 3}, {30, -20, 60});
  const auto volume = test::postop_ct({knee().femur.mesh}, {}, truth, test::half_fine());
  for (const std::uint64_t seed : {2U, 8U})
    EXPECT_FALSE(found_in(volume, phantom::make_phantom_knee({.seed = seed, .edge_length_mm = 2}),
                          bones::BoneKind::Femur)
                     .reliable)
        << seed;
  const FoundBone left =
      found_in(volume, phantom::make_phantom_knee({.side = bones::Side::Left, .edge_length_mm = 2}),
               bones::BoneKind::Femur);
  EXPECT_FALSE(left.reliable);
  EXPECT_FALSE(left.reasons.empty());
  const FoundBone tibia = found_in(volume, knee(), bones::BoneKind::Tibia);
  EXPECT_FALSE(tibia.is_found);
  EXPECT_FALSE(tibia.reliable);
  // Why that may be: who looks at it knows whose images he took.
  EXPECT_THAT(tibia.reasons,
              testing::Contains(testing::AllOf(HasSubstr("another patient's"), HasSubstr("other side"))));
}

// A scan that ends within the condyles.
TEST(BonePose, ABoneThatIsCutOffIsNotReliable) {
  test::KnownCtOptions options = test::half_fine();
  const RigidTransform truth = test::lying(0, {0, 0, 1}, {0, 0, 0});
  options.highest_mm = geometry::bounds_of(knee().femur.mesh).min_mm.z() + 16;
  const auto volume = test::postop_ct({knee().femur.mesh}, {}, truth, options);
  EXPECT_FALSE(found_in(volume, knee(), bones::BoneKind::Femur).reliable);
}

// Images no higher than the joint: each bone is found where it is, too little of it to rely on, and what
// would be enough is said.
TEST(BonePose, LowImagesShowWhereTheBonesLie) {
  const RigidTransform truth = test::lying(15, {1, 2, 3}, {30, -20, 60});
  const Eigen::Vector3d joint =
      truth * Eigen::Vector3d(0, 0,
                              0.5 * (geometry::bounds_of(knee().femur.mesh).min_mm.z() +
                                     geometry::bounds_of(knee().tibia.mesh).max_mm.z()));
  test::KnownCtOptions options = test::half_fine();
  options.lowest_mm = joint.z() - 31;
  options.highest_mm = joint.z() + 31;
  const auto volume = test::postop_ct({knee().femur.mesh, knee().tibia.mesh}, {}, truth, options);
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    const FoundBone found = found_in(volume, knee(), kind);
    ASSERT_TRUE(found.is_found) << to_text(kind);
    EXPECT_LT(off_mm(found, truth, knee().femoral_tunnel.entry_mm), 0.2) << to_text(kind);
    EXPECT_THAT(found.reasons, testing::Contains(HasSubstr("60 mm of it"))) << to_text(kind);
  }
}

}  // namespace
}  // namespace arthronaut::postop
