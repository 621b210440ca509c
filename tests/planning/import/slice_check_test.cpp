#include "planning/import/slice_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/images/volume_writer.h"
#include "planning/import/bone_import.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/planning/segmentation/known_ct.h"
#include "tests/temporary_folder.h"

namespace arthronaut::importing {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// A CT of 5 mm slices gave a femur 9 mm too tall without a word; all of both bones is in doubt, and what 1 mm
// slices show is not.
TEST(SliceCheck, BonesOfThickSlicesAreDoubted) {
  const auto knee = phantom::make_phantom_knee({.edge_length_mm = 1.5});
  const test::TemporaryFolder folder;
  const auto import_of = [&](double slice_mm) {
    test::KnownCtOptions options;
    options.spacing_mm = {0.8, 0.8, slice_mm};
    const images::Volume ct = test::known_ct({knee.femur.mesh, knee.tibia.mesh}, options);
    images::write_volume(folder / "right.nrrd", ct);
    return import_bones(folder / "right.nrrd");
  };
  const BoneImport thick = import_of(3), thin = import_of(1.25);
  ASSERT_EQ(thick.bones.size(), 2U);
  ASSERT_EQ(thin.bones.size(), 2U);
  for (const ImportedBone& bone : thick.bones)
    EXPECT_THAT(bone.doubts,
                Contains(AllOf(HasSubstr("slices are 3.0 mm apart"), HasSubstr("1.5 mm or more"))));
  for (const ImportedBone& bone : thin.bones) EXPECT_THAT(bone.doubts, Not(Contains(HasSubstr("apart"))));
}

// A label map is no better: what lies between two of its slices nobody has labelled.
TEST(SliceCheck, BonesOfAThickLabelMapAreDoubted) {
  const test::TemporaryFolder folder;
  const auto doubts_at = [&](double slice_mm) {
    images::Volume labels;
    labels.size = {40, 40, 30};
    labels.lps_from_index.linear() = Eigen::Vector3d(1, 1, slice_mm).asDiagonal();
    labels.values.assign(static_cast<std::size_t>(labels.size.prod()), 0.0F);
    for (int k = 5; k < 25; ++k)
      for (int j = 5; j < 35; ++j)
        for (int i = 5; i < 35; ++i) labels.values[labels.index(i, j, k)] = 1.0F;
    images::write_volume(folder / "right.nrrd", labels);
    BoneImportOptions options;
    options.labels = {{bones::BoneKind::Femur, 1}};
    return import_bones(folder / "right.nrrd", options).bones.at(0).doubts;
  };
  EXPECT_THAT(doubts_at(4.2), Contains(AllOf(HasSubstr("slices are 4.2 mm apart"), HasSubstr("2.1 mm or"))));
  EXPECT_THAT(doubts_at(1.5), Not(Contains(HasSubstr("apart"))));
}

TEST(SliceCheck, TheLimitIsTheMeasuredOne) {
  images::Volume ct;
  ct.lps_from_index.linear() = Eigen::Vector3d(0.6, 0.6, 1.504).asDiagonal();
  EXPECT_EQ(slice_doubt(ct), "");
  ct.lps_from_index.linear() = Eigen::Vector3d(0.6, 0.6, 2).asDiagonal();
  EXPECT_THAT(slice_doubt(ct), HasSubstr("2.0 mm apart"));
  ct.lps_from_index.linear() = Eigen::Vector3d(2, 0.6, 0.6).asDiagonal();  // sagittal ones
  EXPECT_NE(slice_doubt(ct), "");
}

}  // namespace
}  // namespace arthronaut::importing
