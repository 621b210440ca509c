// What post-operative images are read from, and what is refused.
#include "planning/postop/postop_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "planning/bones/mesh_file.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_writer.h"
#include "tests/message_of.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/temporary_folder.h"

namespace arthronaut::postop {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class PostopSource : public ::testing::Test {
 protected:
  std::string refusal(const std::string& name, const PostopSourceOptions& options = {}) {
    return test::message_of<InvalidInput>([&] { (void)read_postop(folder_ / name, options); });
  }
  images::Volume small(const std::string& modality) {
    images::Volume volume;
    volume.size = {4, 4, 4};
    volume.values.assign(64, 0.0F);
    volume.values[21] = 2;
    volume.values[22] = 5;
    volume.modality_in_file = modality;
    return volume;
  }
  test::TemporaryFolder folder_;
};

// 1000 HU in it, 0 HU outside, and as much of the bone in all voxels as there is.
TEST_F(PostopSource, AMeshBecomesAPicture) {
  bones::write_mesh_stl(folder_ / "ball.stl", test::ellipsoid({12, 10, 15}, 4, {5, 6, 7}));
  const images::Volume volume = read_postop(folder_ / "ball.stl");
  double sum = 0;
  for (const float value : volume.values) sum += value;
  const double volume_mm3 = 4.0 / 3 * M_PI * 12 * 10 * 15;
  EXPECT_NEAR(sum / 1000 * std::pow(volume.spacing_mm().x(), 3) / volume_mm3, 1, 0.01);
  const Eigen::Vector3d middle = volume.lps_from_index.inverse() * Eigen::Vector3d(5, 6, 7);
  EXPECT_NEAR(
      volume.at(static_cast<int>(middle.x()), static_cast<int>(middle.y()), static_cast<int>(middle.z())),
      1000, 1);
}

TEST_F(PostopSource, LabelsBecomeBone) {
  images::write_volume(folder_ / "labels.nrrd", small(""));
  EXPECT_EQ(read_postop(folder_ / "labels.nrrd").values[22], 1000);
  const auto named = read_postop(folder_ / "labels.nrrd", {.labels = {2}});
  EXPECT_EQ(named.values[21], 1000);
  EXPECT_EQ(named.values[22], 0);
  EXPECT_THAT(refusal("labels.nrrd", {.labels = {3}}), AllOf(HasSubstr("labels.nrrd"), HasSubstr("label 3")));
}

TEST_F(PostopSource, WhatShowsNoTunnelIsRefused) {
  images::write_volume(folder_ / "mr.nrrd", small("MR"));
  EXPECT_THAT(refusal("mr.nrrd"), AllOf(HasSubstr("mr.nrrd"), HasSubstr("MR")));
  std::ofstream(folder_ / "notes.txt") << "no images";
  EXPECT_THAT(refusal("notes.txt"), HasSubstr("notes.txt"));
  EXPECT_THROW((void)read_postop(folder_ / "none.nrrd"), IoError);
}

// A hospital's folder: the scan by two kernels, a scout, a report. Both CTs may be compared, the finer first;
// the scout is none, and neither is a volume that is no DICOM.
TEST_F(PostopSource, SaysWhichCtsOfAFolderMayBeCompared) {
  const auto write = [&](const std::string& uid, double step_mm, int slices) {
    test::DicomSeriesForm form;
    form.origin.series_uid = uid;
    images::Volume volume = small("CT");
    volume.size.z() = slices;
    volume.values.resize(static_cast<std::size_t>(16 * slices), 0.0F);
    volume.lps_from_index.linear().diagonal() = Eigen::Vector3d(0.4, 0.4, step_mm);
    test::write_dicom_series(folder_ / uid, volume, form);
  };
  write("1.2.3.1", 1.0, 4);
  write("1.2.3.2", 0.6, 4);
  write("1.2.3.3", 0.5, 1);
  std::ofstream(folder_ / "report.txt") << "no image";
  const auto series = comparable_series(images::find_series(folder_.path()).series);
  ASSERT_EQ(series.size(), 2U);
  EXPECT_EQ(series[0].uid, "1.2.3.2");
  EXPECT_EQ(series[1].uid, "1.2.3.1");
  EXPECT_EQ(read_postop(folder_.path(), {.series = series[0].uid}).spacing_mm().z(), 0.6);
}

}  // namespace
}  // namespace arthronaut::postop
