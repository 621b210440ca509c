// Bones of known images, whole and with a lump of soft tissue painted onto them.
#include "planning/segmentation/bone_beneath.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/bones/mesh_repair.h"
#include "planning/images/bone_surface.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/segmentation/label_surface.h"
#include "tests/planning/segmentation/known_ct.h"
#include "tests/planning/segmentation/known_mr.h"

namespace arthronaut::segmentation {
namespace {

using Eigen::Vector3d;
using Outcome = BoneBeneath::Outcome;

// Where the lump's middle is: on the back of the shaft, so that half of the ball is muscle.
constexpr double kLump_mm = 14;

struct Painted {
  images::Volume images, labels;
  Vector3d lump_mm;
};

// The ball joins the femur's label.
void add_lump(Painted& painted, float femur) {
  Vector3d at_mm = Vector3d::Zero();
  const images::Volume& labels = painted.labels;
  for (int k = 0; k < labels.size.z(); ++k)
    for (int j = 0; j < labels.size.y(); ++j)
      for (int i = 0; i < labels.size.x(); ++i)
        if (const Vector3d p = labels.lps_from_index * Vector3d(i, j, k);
            labels.at(i, j, k) == femur && p.y() - 0.4 * p.z() > at_mm.y() - 0.4 * at_mm.z())
          at_mm = p;
  at_mm.z() += 12;
  painted.lump_mm = at_mm;
  for (int k = 0; k < labels.size.z(); ++k)
    for (int j = 0; j < labels.size.y(); ++j)
      for (int i = 0; i < labels.size.x(); ++i)
        if (labels.at(i, j, k) == 0 && (labels.lps_from_index * Vector3d(i, j, k) - at_mm).norm() < kLump_mm)
          painted.labels.values[labels.index(i, j, k)] = femur;
}

Painted painted_ct() {
  const auto knee = phantom::make_phantom_knee();
  test::KnownCtOptions options;
  options.spacing_mm = {0.8, 0.8, 1.25};
  options.margin_mm = 20;
  Painted painted{test::known_ct({knee.femur.mesh, knee.tibia.mesh}, options), {}, {}};
  painted.images.modality = images::Modality::Ct;
  painted.labels = painted.images;
  const auto femur = test::coverage(knee.femur.mesh, painted.images, 2);
  for (std::size_t v = 0; v < femur.size(); ++v) painted.labels.values[v] = femur[v] > 0.5F ? 1.0F : 0.0F;
  return painted;
}

TEST(BoneBeneath, Hazard50IsEverywhereBeneathAWholeFemurOfACtAndNotBeneathALump) {
  Painted painted = painted_ct();
  const auto look = [&] {
    return bone_beneath(bones::mend_mesh(label_surface_at_edges(painted.images, painted.labels, 1)).mesh,
                        painted.images);
  };
  const BoneBeneath whole = look();
  EXPECT_EQ(whole.outcome, Outcome::Everywhere) << whole.area_cm2 << ' ' << whole.center_mm.transpose();
  add_lump(painted, 1);
  const BoneBeneath leaking = look();
  EXPECT_EQ(leaking.outcome, Outcome::NotEverywhere) << leaking.area_cm2 << leaking.reason;
  EXPECT_LT((leaking.center_mm - painted.lump_mm).norm(), 2 * kLump_mm);
  EXPECT_THAT(leaking.reason, testing::StartsWith("behind"));
}

TEST(BoneBeneath, Hazard50TellsMarrowFromMuscleInAnMrThatIsBrighterOnOneSide) {
  Painted painted;
  painted.labels = test::known_labels();
  painted.images = test::known_mr(painted.labels, 20);
  const auto look = [&] {
    return bone_beneath(bones::mend_mesh(images::surface_of_label(painted.labels, 5).mesh).mesh,
                        painted.images);
  };
  const BoneBeneath whole = look();
  EXPECT_EQ(whole.outcome, Outcome::Everywhere) << whole.area_cm2 << ' ' << whole.center_mm.transpose();
  add_lump(painted, 5);
  const BoneBeneath leaking = look();
  EXPECT_EQ(leaking.outcome, Outcome::NotEverywhere) << leaking.area_cm2 << leaking.reason;
  EXPECT_LT((leaking.center_mm - painted.lump_mm).norm(), 2 * kLump_mm);
}

// Grey values that are all over the place tell nothing, and neither do images of another kind.
TEST(BoneBeneath, SaysWhereItCouldNotLook) {
  Painted painted;
  painted.labels = test::known_labels();
  painted.images = test::known_mr(painted.labels, 20);
  const auto femur = bones::mend_mesh(images::surface_of_label(painted.labels, 5).mesh).mesh;
  for (int k = 0; k < painted.images.size.z(); ++k)
    for (int j = 0; j < painted.images.size.y(); ++j)
      for (int i = 0; i < painted.images.size.x(); ++i)
        painted.images.values[painted.images.index(i, j, k)] = (i / 20 + j / 20 + k / 16) % 2 ? 700 : 200;
  const BoneBeneath patchy = bone_beneath(femur, painted.images);
  EXPECT_EQ(patchy.outcome, Outcome::NotChecked);
  EXPECT_THAT(patchy.reason, testing::HasSubstr("vary"));
  painted.images.modality = images::Modality::Other;
  EXPECT_EQ(bone_beneath(femur, painted.images).outcome, Outcome::NotChecked);
  EXPECT_EQ(bone_beneath({}, painted.images).outcome, Outcome::NotChecked);
}

}  // namespace
}  // namespace arthronaut::segmentation
