// What is and what is not a femur or a tibia: the built-in knee, turned, cut and mixed up.
#include "planning/segmentation/anatomy_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>

#include "planning/phantom/phantom_knee.h"

namespace arthronaut::segmentation {
namespace {

using bones::BoneKind;
using geometry::TriangleMesh;
using testing::Contains;
using testing::HasSubstr;

const TriangleMesh& bone(BoneKind kind, std::uint64_t seed = 1) {
  static std::map<std::uint64_t, phantom::PhantomKnee> knees;
  if (!knees.contains(seed)) {
    phantom::PhantomOptions options;
    options.seed = seed;
    options.edge_length_mm = 3;
    knees[seed] = phantom::make_phantom_knee(options);
  }
  const auto& knee = knees[seed];
  return kind == BoneKind::Femur ? knee.femur.mesh : knee.tibia.mesh;
}

TriangleMesh turned(TriangleMesh mesh, const Eigen::AngleAxisd& rotation) {
  for (auto& p : mesh.vertices_mm) p = rotation * p;
  return mesh;
}

// Of any size, and leaning as legs lie in scanners.
TEST(AnatomyCheck, KneesOfAllSizesPassHoweverTheyLean) {
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
      EXPECT_THAT(anatomy_doubts(bone(kind, seed), kind), testing::IsEmpty()) << seed;
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
                                        Eigen::Vector3d(0.6, -0.8, 0), Eigen::Vector3d(0, 0, 1)}) {
      EXPECT_THAT(anatomy_doubts(turned(bone(kind), Eigen::AngleAxisd(0.5, axis)), kind), testing::IsEmpty())
          << axis.transpose();
    }
  }
}

// The shaft cut off where so much of the bone is left.
TriangleMesh cut_to(TriangleMesh mesh, BoneKind kind, double length_mm) {
  const geometry::Bounds bounds = geometry::bounds_of(mesh);
  for (auto& p : mesh.vertices_mm) {
    p.z() = kind == BoneKind::Femur ? std::min(p.z(), bounds.min_mm.z() + length_mm)
                                    : std::max(p.z(), bounds.max_mm.z() - length_mm);
  }
  return mesh;
}

// A shaft's cut end tells how a bone lies; the flat face that the end of the images has left does not.
TEST(AnatomyCheck, WhereTheImagesEndIsNoShaft) {
  const Eigen::AngleAxisd forwards(-M_PI / 2, Eigen::Vector3d::UnitX());  // its shaft points there
  const TriangleMesh lying = turned(cut_to(bone(BoneKind::Tibia), BoneKind::Tibia, 83), forwards);
  EXPECT_THAT(anatomy_doubts(lying, BoneKind::Tibia), Contains(HasSubstr("axes of the file")));
  const Eigen::Vector3d front = -Eigen::Vector3d::UnitY();
  EXPECT_THAT(anatomy_doubts(lying, BoneKind::Tibia, {&front, 1}),
              testing::AllOf(testing::Not(testing::IsEmpty()),
                             testing::Not(Contains(HasSubstr("axes of the file")))));
}

// The leg of a large knee rolls outwards on the table: from front to back it is then as deep as it is wide.
TEST(AnatomyCheck, ALargeKneeThatIsRolledIsNoneThatLies) {
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    for (const double rolled_deg : {-40, -20, 20, 40}) {
      TriangleMesh mesh =
          turned(bone(kind), Eigen::AngleAxisd(rolled_deg * M_PI / 180, Eigen::Vector3d::UnitZ()));
      for (auto& p : mesh.vertices_mm) p *= 1.2;
      EXPECT_THAT(anatomy_doubts(cut_to(mesh, kind, 75), kind), testing::IsEmpty())
          << bones::to_text(kind) << " " << rolled_deg;
    }
  }
}

TEST(AnatomyCheck, OneBoneIsNotTheOther) {
  EXPECT_THAT(anatomy_doubts(bone(BoneKind::Tibia), BoneKind::Femur), Contains(HasSubstr("femur")));
  EXPECT_THAT(anatomy_doubts(bone(BoneKind::Femur), BoneKind::Tibia), Contains(HasSubstr("tibia")));
}

// Femur and tibia in one: what a scan of a worn knee gave as a "femur".
TEST(AnatomyCheck, BothBonesInOneAreSeen) {
  TriangleMesh both = bone(BoneKind::Femur);
  const TriangleMesh tibia = bone(BoneKind::Tibia);
  const auto offset = static_cast<std::int32_t>(both.vertices_mm.size());
  both.vertices_mm.insert(both.vertices_mm.end(), tibia.vertices_mm.begin(), tibia.vertices_mm.end());
  for (auto t : tibia.triangles) both.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  EXPECT_THAT(anatomy_doubts(both, BoneKind::Femur), testing::Not(testing::IsEmpty()));
  EXPECT_THAT(anatomy_doubts(both, BoneKind::Tibia), testing::Not(testing::IsEmpty()));
}

// As files have it whose y is up.
TEST(AnatomyCheck, AxesThatAreNotThePatientsAreSeen) {
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)}) {
      for (const double angle : {M_PI / 2, -M_PI / 2}) {
        EXPECT_THAT(anatomy_doubts(turned(bone(kind), Eigen::AngleAxisd(angle, axis)), kind),
                    Contains(HasSubstr("axes of the file")))
            << bones::to_text(kind) << " " << angle << " about " << axis.transpose();
      }
    }
  }
}

TEST(AnatomyCheck, WrongSizesAreSeen) {
  for (const double scale : {0.4, 2.0}) {
    TriangleMesh mesh = bone(BoneKind::Femur);
    for (auto& p : mesh.vertices_mm) p *= scale;
    EXPECT_THAT(anatomy_doubts(mesh, BoneKind::Femur), Contains(HasSubstr("largest section"))) << scale;
  }
  EXPECT_FALSE(anatomy_doubts({}, BoneKind::Femur).empty());
}

}  // namespace
}  // namespace arthronaut::segmentation
