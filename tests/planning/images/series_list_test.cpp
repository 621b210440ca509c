// The list of what a folder holds: the same verdict as opening it, and no broken file hides the others.
#include "planning/images/series_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/planning/images/enhanced_dicom.h"
#include "tests/planning/images/volume_forms.h"
#include "tests/temporary_folder.h"

namespace arthronaut::images {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

// The slices of the volume in files whose names do not tell their order.
void write_series(const std::filesystem::path& folder, const std::string& uid, int left_out = -1) {
  std::filesystem::create_directories(folder);
  int k = 0;
  for (auto& [name, slice] : test::dicom_slices(test::oblique_volume())) {
    test::DicomSliceForm form = slice;
    form.series_uid = uid;
    const double depth = (form.position_mm - test::oblique_volume().lps_from_index.translation()).norm();
    const double step = test::oblique_volume().spacing_mm().z();
    if (std::lround(depth / step) != left_out) test::write_bytes(folder / name, test::dicom(form));
    ++k;
  }
  ASSERT_EQ(k, 4);
}

// One slice of series `uid` that breaks off within its pixels.
void write_broken(const std::filesystem::path& file, const std::string& uid, std::size_t bytes = 0) {
  test::DicomSliceForm form = test::dicom_slices(test::oblique_volume()).begin()->second;
  form.series_uid = uid;
  const std::string whole = test::dicom(form);
  test::write_bytes(file, whole.substr(0, bytes > 0 ? bytes : whole.size() - 3));
}

// A file that is broken keeps nobody from another series, and is said to be left out. One of the series
// itself does; of what does not say its series the others tell whether a slice is missing.
TEST(SeriesList, ABrokenFileOfAnotherSeriesIsLeftOut) {
  const TemporaryFolder folder;
  write_series(folder.path(), "1.2.3.4");
  write_broken(folder / "other.dcm", "1.2.3.5");
  write_broken(folder / "short.dcm", "1.2.3.4", 300);
  for (const char* const series : {"", "1.2.3.4"}) {
    const Volume volume = read_volume(folder.path(), {.series = series});
    EXPECT_EQ(volume.size, test::oblique_volume().size);
    EXPECT_THAT(volume.notes,
                testing::Contains(testing::AllOf(HasSubstr("left out: other.dcm: "), HasSubstr("cut off"),
                                                 HasSubstr("of another series"))));
    EXPECT_THAT(volume.notes,
                testing::Contains(testing::AllOf(HasSubstr("left out: short.dcm: "),
                                                 HasSubstr("does not say which series it is of"))));
  }
  write_broken(folder / "same.dcm", "1.2.3.4");
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)read_volume(folder.path()); }),
              testing::AllOf(HasSubstr("same.dcm"), HasSubstr("cut off")));
}

TEST(SeriesList, TheSliceThatABrokenFileWasIsMissed) {
  const TemporaryFolder folder;
  write_series(folder.path(), "1.2.3.4", 1);
  write_broken(folder / "short.dcm", "1.2.3.4", 300);
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)read_volume(folder.path()); }),
              HasSubstr("a slice is missing"));
}

TEST(SeriesList, SaysWhatEachSeriesIsAndWhatIsWrongWithIt) {
  const TemporaryFolder folder;
  write_series(folder / "whole", "1.2.3.4");
  write_series(folder / "gap", "1.2.3.5", 1);
  test::write_bytes(folder / "cut.dcm",
                    test::dicom(test::dicom_slices(test::oblique_volume()).begin()->second).substr(0, 300));
  test::write_bytes(folder / "readme.txt", "hello");
  test::write_bytes(folder / "volume.nrrd", test::nrrd(test::oblique_volume(), false, true));
  const SeriesList list = find_series(folder.path());
  ASSERT_EQ(list.series.size(), 3U);
  const ImageSeries& whole = list.series[0];
  EXPECT_EQ(whole.uid, "1.2.3.4");
  EXPECT_EQ(whole.modality, "CT");
  EXPECT_EQ(whole.size, test::oblique_volume().size);
  EXPECT_LT((whole.spacing_mm - test::oblique_volume().spacing_mm()).norm(), 1e-6);
  EXPECT_TRUE(whole.is_readable());
  EXPECT_EQ(whole.files.size(), 4U);
  ASSERT_FALSE(whole.warnings.empty());
  EXPECT_THAT(whole.warnings[0], HasSubstr("4 slices only"));
  EXPECT_THAT(list.series[1].refusal, HasSubstr("a slice is missing"));
  EXPECT_EQ(list.series[2].format, "NRRD");
  EXPECT_EQ(list.series[2].size, test::oblique_volume().size);
  ASSERT_EQ(list.skipped.size(), 1U);
  EXPECT_EQ(list.skipped[0].file.filename(), "cut.dcm");
  EXPECT_THAT(list.skipped[0].reason, HasSubstr("cut off"));
  EXPECT_EQ(list.other_count, 1U);
}

// The files stand in the order of the slices: the browser counts on it for its picture.
TEST(SeriesList, FilesAreInTheOrderOfTheSlices) {
  const TemporaryFolder folder;
  write_series(folder / "whole", "1.2.3.4");
  const auto forms = test::dicom_slices(test::oblique_volume());
  const ImageSeries series = find_series(folder.path()).series.at(0);
  double last = -1e9;
  for (const auto& file : series.files) {
    const auto& form = forms.at(file.filename().string());
    const double depth = form.along_columns.cross(form.along_rows).dot(form.position_mm);
    EXPECT_GT(depth, last);
    last = depth;
  }
}

// A folder that was copied into itself: each image is there once, by its own name.
TEST(SeriesList, ACopyOfAnImageIsLeftOutAndSaid) {
  const TemporaryFolder folder;
  test::write_dicom_series(folder.path(), test::oblique_volume(), {});
  std::filesystem::copy_file(folder / "slice1001.dcm", folder / "slice1001 (1).dcm");
  const auto list = find_series(folder.path());
  ASSERT_EQ(list.series.size(), 1U);
  EXPECT_EQ(list.series.front().refusal, "");
  EXPECT_EQ(list.series.front().size.z(), test::oblique_volume().size.z());
  EXPECT_THAT(list.series.front().warnings, testing::Contains(HasSubstr("1 copy of images")));
}

// A scout beside the one volume is nobody's choice.
TEST(SeriesList, AScoutBesideTheVolumeDoesNotAskForAChoice) {
  const TemporaryFolder folder;
  write_series(folder / "whole", "1.2.3.4");
  auto scout = test::dicom_slices(test::oblique_volume()).begin()->second;
  scout.series_uid = "1.2.3.1";
  scout.along_rows = scout.along_columns.cross(scout.along_rows);  // across the slices
  test::write_bytes(folder / "scout.dcm", test::dicom(scout));
  EXPECT_EQ(find_series(folder.path()).series.size(), 2U);
  EXPECT_EQ(read_volume(folder.path()).size, test::oblique_volume().size);
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)read_volume(folder.path(), {"1.2.3.1"}); }),
              HasSubstr("one slice only"));
}

// A step from dark to bright, twice as high in the patient as wide.
TEST(SeriesList, ThumbnailHasTheProportionsOfThePatient) {
  const TemporaryFolder folder;
  Volume volume;
  volume.size = {7, 5, 4};
  volume.lps_from_index.linear() = Eigen::Vector3d(1.0, 2.8, 1.0).asDiagonal();
  for (int v = 0; v < 140; ++v) volume.values.push_back(v % 7 < 4 ? -500.0F : 700.0F);
  test::write_bytes(folder / "step.nrrd", test::nrrd(volume, false, false));
  const SeriesList list = find_series(folder / "step.nrrd");
  const Thumbnail picture = thumbnail_of(list.series.at(0), 28);
  ASSERT_EQ(picture.height, 28);
  ASSERT_EQ(picture.width, 14);  // 7 mm of 14 mm
  EXPECT_EQ(picture.grey.at(14 * 10 + 3), 0);
  EXPECT_EQ(picture.grey.at(14 * 10 + 12), 255);
}

TEST(SeriesList, OfOneFrameOfAnEnhancedFileAPicture) {
  const TemporaryFolder folder;
  test::write_enhanced_dicom(folder / "enhanced.dcm", test::oblique_volume());
  const SeriesList list = find_series(folder.path());
  ASSERT_EQ(list.series.size(), 1U);
  EXPECT_EQ(list.series[0].files.size(), 1U);
  EXPECT_EQ(list.series[0].size, test::oblique_volume().size);
  EXPECT_EQ(thumbnail_of(list.series[0], 64).grey.size(),
            static_cast<std::size_t>(thumbnail_of(list.series[0], 64).width *
                                     thumbnail_of(list.series[0], 64).height));
}

TEST(SeriesList, NothingThereIsSaid) {
  const TemporaryFolder folder;
  EXPECT_THROW((void)find_series(folder / "absent"), IoError);
  test::write_bytes(folder / "notes.txt", "hello");
  EXPECT_TRUE(find_series(folder.path()).series.empty());
  EXPECT_THROW((void)find_series(folder / "notes.txt"), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::images
