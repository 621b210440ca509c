#include "planning/images/volume_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/images/volume_bytes.h"
#include "planning/images/volume_writer.h"
#include "tests/message_of.h"
#include "tests/planning/images/same_volume.h"
#include "tests/planning/images/volume_forms.h"
#include "tests/temporary_folder.h"

namespace arthronaut::images {
namespace {

using test::expect_same;
using test::message_of;
using test::TemporaryFolder;
using test::write_bytes;
using testing::AllOf;
using testing::HasSubstr;

// An even value in every voxel, so that the DICOM's slope of 2 loses nothing.
Volume even_volume() {
  Volume volume = test::oblique_volume();
  for (float& v : volume.values) v = 2 * std::floor(v / 2);
  return volume;
}

void write_series(const TemporaryFolder& folder, const std::map<std::string, test::DicomSliceForm>& slices) {
  for (const auto& [name, slice] : slices) write_bytes(folder / name, test::dicom(slice));
}

// One oblique volume in eight files: the same voxels at the same places in the patient.
TEST(VolumeFile, EveryFormatGivesTheSameVolume) {
  const TemporaryFolder folder;
  for (const auto& [name, contents] : test::all_volume_forms(test::oblique_volume())) {
    SCOPED_TRACE(name);
    write_bytes(folder / name, contents);
    ASSERT_TRUE(is_volume_source(folder / name));
    expect_same(read_volume(folder / name), test::oblique_volume());
  }
}

// What a file does not say is told by the air of a CT, whatever the format; what it says is believed.
TEST(VolumeFile, OfNoStatedModalityIsACtWhereItHoldsAir) {
  const TemporaryFolder folder;
  for (const auto& [least, expected] : {std::pair{-1000.F, Modality::Ct}, {-400.F, Modality::Unknown}}) {
    Volume volume = test::oblique_volume();
    for (float& value : volume.values) value = std::max(value, -400.F);
    volume.values[7] = least;
    write_bytes(folder / "a.nii", test::nifti(volume, std::endian::little));
    write_bytes(folder / "a.nrrd", test::nrrd(volume, false, false));
    write_bytes(folder / "a.mha", test::metaimage(volume, false));
    for (const char* name : {"a.nii", "a.nrrd", "a.mha"})
      EXPECT_EQ(read_volume(folder / name).modality, expected) << name << ", " << least;
    for (const auto& [said, said_modality] :
         {std::pair{"CT", Modality::Ct}, {"MR", Modality::Mr}, {"PT", Modality::Other}}) {
      volume.modality_in_file = said;
      write_volume(folder / "b.nrrd", volume);
      EXPECT_EQ(read_volume(folder / "b.nrrd").modality, said_modality) << said << ", " << least;
    }
  }
}

// A file that counts in centimetres is as large as it is.
TEST(VolumeFile, AnNrrdInAnotherUnitIsReadInMillimetres) {
  const TemporaryFolder folder;
  const std::string in_mm = test::nrrd(test::oblique_volume(), false, false);
  const auto with_units = [&](const std::string& units) {
    std::string text = in_mm;
    text.insert(text.find("sizes"), "space units: " + units + "\n");
    write_bytes(folder / "a.nrrd", text);
    return read_volume(folder / "a.nrrd").lps_from_index.matrix();
  };
  const Eigen::Matrix4d mm = with_units(R"("mm" "mm" "mm")");
  Eigen::Matrix4d cm = with_units(R"("cm" "cm" "cm")");
  EXPECT_LT((mm - test::oblique_volume().lps_from_index.matrix()).norm(), 1e-3);
  cm.topRows<3>() /= 10;
  EXPECT_LT((cm - mm).norm(), 1e-9);
  EXPECT_EQ(with_units(R"("" "" "")"), mm) << "not told";
  EXPECT_THROW((void)with_units(R"("mm" "cm" "mm")"), InvalidInput);
  EXPECT_THROW((void)with_units(R"("in" "in" "in")"), InvalidInput);
}

TEST(VolumeFile, TruncatedFilesAreRefused) {
  const TemporaryFolder folder;
  for (const auto& [name, contents] : test::all_volume_forms(test::oblique_volume())) {
    SCOPED_TRACE(name);
    for (int tenth = 0; tenth < 10; ++tenth) {
      write_bytes(folder / name, contents.substr(0, contents.size() * static_cast<std::size_t>(tenth) / 10));
      EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder / name); }), HasSubstr(name))
          << tenth;
    }
    write_bytes(folder / name, contents.substr(0, contents.size() - 1));
    EXPECT_THROW((void)read_volume(folder / name), InvalidInput);
  }
}

// Without an orientation a knee could be mirrored: no guess.
TEST(VolumeFile, WithoutOrientationIsRefused) {
  const TemporaryFolder folder;
  std::string nifti = test::nifti(test::oblique_volume(), std::endian::little);
  nifti[254] = 0;
  write_bytes(folder / "a.nii", nifti);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder / "a.nii"); }), HasSubstr("sform"));
  std::string nrrd = test::nrrd(test::oblique_volume(), false, false);
  nrrd.erase(nrrd.find("space: "), nrrd.find("sizes") - nrrd.find("space: "));
  write_bytes(folder / "a.nrrd", nrrd);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder / "a.nrrd"); }),
              HasSubstr("where left is"));
  std::string meta = test::metaimage(test::oblique_volume(), false);
  meta.erase(meta.find("TransformMatrix"), meta.find("Offset") - meta.find("TransformMatrix"));
  write_bytes(folder / "a.mha", meta);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder / "a.mha"); }),
              HasSubstr("transformmatrix"));
}

TEST(VolumeFile, DetachedDataOnlyFromTheSameFolder) {
  const TemporaryFolder folder;
  const std::string whole = test::metaimage(test::oblique_volume(), false);
  const std::size_t split = whole.find("LOCAL");
  write_bytes(folder / "a.mhd", whole.substr(0, split) + "a.raw\n");
  write_bytes(folder / "a.raw", whole.substr(split + 6));
  expect_same(read_volume(folder / "a.mhd"), test::oblique_volume());
  write_bytes(folder / "d.mhd", whole.substr(0, split) + "absent.raw\n");
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder / "d.mhd"); }),
              AllOf(HasSubstr("d.mhd"), HasSubstr("absent.raw"), HasSubstr("not there")));
  // What cuts off a name would cut off the message about it, too.
  write_bytes(folder / "c.mhd", whole.substr(0, split) + std::string("\0LOCAL\n", 7));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder / "c.mhd"); }),
              AllOf(HasSubstr("c.mhd"), HasSubstr("control characters")));
  write_bytes(folder / "b.mhd", whole.substr(0, split) + "../../etc/passwd\n");
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder / "b.mhd"); }),
              HasSubstr("same folder"));
}

// Sorted by position, spacing by positions (the thickness in these headers is a lie), rescaled.
TEST(DicomSeries, IsSortedByPosition) {
  const TemporaryFolder folder;
  write_series(folder, test::dicom_slices(even_volume()));
  write_bytes(folder / "README.txt", "not an image");
  const Volume volume = read_volume(folder.path());
  EXPECT_EQ(volume.modality, Modality::Ct);
  // The normal of the slices decides which end is first: this volume's third axis runs along it or against
  // it.
  expect_same(volume, even_volume());
}

// A gantry tilt shears the grid: the affine must follow.
TEST(DicomSeries, ATiltedGantryIsASheardGrid) {
  Volume sheared = even_volume();
  sheared.lps_from_index.linear().col(2) += sheared.lps_from_index.linear().col(1) * 0.8;
  const TemporaryFolder folder;
  write_series(folder, test::dicom_slices(sheared));
  expect_same(read_volume(folder.path()), sheared);
}

// A copy that straightened the slices' places and kept what the header says: nobody can tell which is right.
TEST(DicomSeries, ATiltThatThePlacesDoNotShowIsSaid) {
  Volume sheared = even_volume();
  sheared.lps_from_index.linear().col(2) += sheared.lps_from_index.linear().col(1) * 0.8;
  const auto notes_of = [](const Volume& written, const char* tilt) {
    const TemporaryFolder folder;
    auto slices = test::dicom_slices(written);
    for (auto& [name, slice] : slices) slice.gantry_tilt = tilt;
    write_series(folder, slices);
    return read_volume(folder.path()).notes;
  };
  EXPECT_THAT(notes_of(even_volume(), "-12"), testing::Contains(HasSubstr("gantry tilt of 12.0 degrees")));
  const Eigen::Matrix3d axes = sheared.lps_from_index.linear();
  const double tilt_deg = geometry::deg_from_rad(
      std::acos(std::abs(axes.col(2).normalized().dot(axes.col(0).cross(axes.col(1)).normalized()))));
  ASSERT_GT(tilt_deg, 5);
  EXPECT_THAT(notes_of(sheared, std::to_string(tilt_deg).c_str()),
              testing::Not(testing::Contains(HasSubstr("tilt"))));
  for (const char* none : {"", "0", "0.2"})
    EXPECT_THAT(notes_of(even_volume(), none), testing::Not(testing::Contains(HasSubstr("tilt")))) << none;
}

// As even as a whole series: only the scanner's own count tells. It may run downwards.
TEST(DicomSeries, EverySecondSliceMissingIsSaid) {
  const auto notes_of = [](const std::function<std::string(int)>& number) {
    const TemporaryFolder folder;
    auto slices = test::dicom_slices(even_volume());
    std::vector<test::DicomSliceForm*> by_place;
    for (auto& [name, slice] : slices) by_place.push_back(&slice);
    std::sort(by_place.begin(), by_place.end(),
              [](const auto* a, const auto* b) { return a->position_mm.z() < b->position_mm.z(); });
    for (std::size_t k = 0; k < by_place.size(); ++k)
      by_place[k]->instance_number = number(static_cast<int>(k));
    write_series(folder, slices);
    return read_volume(folder.path()).notes;
  };
  const auto said = testing::Contains(HasSubstr("numbered in steps of 2"));
  EXPECT_THAT(notes_of([](int k) { return std::to_string(1 + 2 * k); }), said);
  EXPECT_THAT(notes_of([](int k) { return std::to_string(91 - 2 * k); }), said);
  for (const auto& whole :
       {+[](int k) { return std::to_string(k); }, +[](int) { return std::string(); },
        +[](int) { return std::string("7"); }, +[](int k) { return std::to_string(k == 0 ? 0 : k + 1); }})
    EXPECT_THAT(notes_of(whole), testing::Not(testing::Contains(HasSubstr("steps"))));
}

TEST(DicomSeries, AMissingSliceIsRefusedWithItsPlace) {
  const TemporaryFolder folder;
  Volume longer = even_volume();
  auto slices = test::dicom_slices(longer);
  for (auto& [name, slice] : slices) {
    // Two more beyond the end, then one taken away in the middle.
    auto shifted = slice;
    shifted.position_mm = slice.position_mm + longer.lps_from_index.linear() * Eigen::Vector3d(0, 0, 4);
    write_bytes(folder / ("more" + name), test::dicom(shifted));
  }
  write_series(folder, slices);
  EXPECT_NO_THROW((void)read_volume(folder.path()));
  std::filesystem::remove(folder / "moreimage0.dcm");
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder.path()); }),
              AllOf(HasSubstr("6.50 mm"), HasSubstr("3.25 mm"), HasSubstr("missing")));
}

TEST(DicomSeries, OddImagesAreRefusedByName) {
  const auto with_odd = [](const auto& change) {
    const TemporaryFolder folder;
    auto slices = test::dicom_slices(even_volume());
    change(slices.begin()->second);
    write_series(folder, slices);
    return message_of<InvalidInput>([&] { (void)read_volume(folder.path()); });
  };
  using Slice = test::DicomSliceForm;
  EXPECT_THAT(with_odd([](Slice& s) { s.columns = 5, s.rows = 7; }),
              AllOf(HasSubstr(".dcm"), HasSubstr("pixels")));
  EXPECT_THAT(with_odd([](Slice& s) { std::swap(s.along_rows, s.along_columns); }), HasSubstr("angle"));
  EXPECT_THAT(with_odd([](Slice& s) { s.column_spacing_mm = 0.6; }), HasSubstr("spacing"));
  EXPECT_THAT(with_odd([](Slice& s) { s.position_mm += 2 * s.along_rows; }), HasSubstr("beside the line"));
  EXPECT_THAT(with_odd([](Slice& s) { s.stored.resize(20); }), HasSubstr("pixel"));
  EXPECT_THAT(with_odd([](Slice& s) { s.series_uid = "1.2.3.5"; }), HasSubstr("--series"));
  EXPECT_THAT(with_odd([](Slice& s) { s.slope = std::nan(""); }),
              AllOf(HasSubstr(".dcm"), HasSubstr("rescaling holds no numbers")));
}

TEST(DicomSeries, TheSameSliceTwiceIsRefused) {
  const TemporaryFolder folder;
  const auto slices = test::dicom_slices(even_volume());
  write_series(folder, slices);
  write_bytes(folder / "copy.dcm", test::dicom(slices.begin()->second));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder.path()); }),
              AllOf(HasSubstr("same place"), HasSubstr("copy.dcm")));
}

// Scanners put the scout into the series that was planned on it, first of all or last.
TEST(DicomSeries, AScoutAcrossTheSlicesIsLeftOutAndSaid) {
  for (const char* name : {"0_scout.dcm", "z_scout.dcm"}) {
    const TemporaryFolder folder;
    const auto slices = test::dicom_slices(even_volume());
    write_series(folder, slices);
    test::DicomSliceForm scout = slices.begin()->second;
    scout.along_rows = scout.along_columns.cross(scout.along_rows);
    std::swap(scout.rows, scout.columns);
    write_bytes(folder / name, test::dicom(scout));
    const Volume volume = read_volume(folder.path());
    expect_same(volume, even_volume());
    EXPECT_THAT(volume.notes, testing::Contains(AllOf(HasSubstr("across the others"), HasSubstr(name))));
  }
}

TEST(DicomSeries, OfSeveralEchoesTheFirstIsTakenAndSaid) {
  const TemporaryFolder folder;
  for (const char* echo : {"30", "10", "20.5"}) {
    for (auto [name, slice] : test::dicom_slices(even_volume())) {
      slice.echo_time = echo;
      slice.modality = "MR";
      if (std::string(echo) != "10") slice.intercept = 5000;
      write_bytes(folder / (echo + name), test::dicom(slice));
    }
  }
  const Volume volume = read_volume(folder.path());
  expect_same(volume, even_volume());
  EXPECT_THAT(volume.notes, testing::Contains(AllOf(HasSubstr("3 echoes"), HasSubstr("10 ms"))));
}

TEST(DicomSeries, OneOfSeveralSeriesIsChosenByName) {
  const TemporaryFolder folder;
  write_series(folder, test::dicom_slices(even_volume()));
  for (auto [name, slice] : test::dicom_slices(even_volume())) {
    slice.series_uid = "1.2.3.77";
    slice.intercept = 0;
    write_bytes(folder / ("other" + name), test::dicom(slice));
  }
  EXPECT_THROW((void)read_volume(folder.path()), InvalidInput);
  expect_same(read_volume(folder.path(), {"1.2.3.4"}), even_volume());
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder.path(), {"9"}); }),
              HasSubstr("1.2.3.77"));
}

TEST(DicomSeries, EmptyAndForeignFoldersAreRefused) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder.path()); }), HasSubstr("is empty"));
  write_bytes(folder / "letter.txt", "Dear colleague");
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder.path()); }), HasSubstr("no DICOM"));
  write_bytes(folder / "slice.dcm", test::dicom(test::dicom_slices(even_volume()).begin()->second));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder.path()); }), HasSubstr("one slice"));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder / "slice.dcm"); }),
              HasSubstr("folder"));
}

// A thousand broken files for each parser: a volume that is whole, or InvalidInput, and nothing else.
TEST(VolumeFileFuzz, BrokenFilesGiveAWholeVolumeOrInvalidInput) {
  const TemporaryFolder folder;
  for (const auto& [name, contents] : test::all_volume_forms(test::oblique_volume())) {
    SCOPED_TRACE(name);
    std::mt19937 random(3);
    const auto below = [&](std::size_t n) {
      return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
    };
    for (int i = 0; i < 1000; ++i) {
      std::string broken = contents;
      for (std::size_t n = 1 + below(3); n > 0 && !broken.empty(); --n) {
        const std::size_t at = below(std::min<std::size_t>(broken.size(), below(3) ? 400 : broken.size()));
        switch (below(6)) {
          case 0:
            broken[at] = static_cast<char>(below(256));
            break;
          case 1:
            broken[at] ^= static_cast<char>(1U << below(8));
            break;
          case 2:
            broken.resize(at);
            break;
          case 3:
            broken.erase(at, below(9));
            break;
          case 4:
            broken.insert(at, "99999");
            break;
          default:
            broken[at] = "0123456789-nN\n "[below(15)];
        }
      }
      const auto parse = name.ends_with(".nrrd")  ? parse_nrrd
                         : name.ends_with(".mha") ? parse_metaimage
                                                  : parse_nifti;
      try {
        const Volume volume = parse(folder / name, broken, VolumeFileOptions{}.most_bytes);
        ASSERT_EQ(volume.values.size(), static_cast<std::size_t>(volume.size.cast<std::int64_t>().prod()));
        for (const float v : volume.values) ASSERT_TRUE(std::isfinite(v)) << i;
        ASSERT_TRUE(volume.lps_from_index.matrix().allFinite());
      } catch (const InvalidInput&) {
      } catch (const IoError&) {  // a header that now names a data file which is not there
      } catch (const std::exception& error) {
        FAIL() << "mutation " << i << " threw something else: " << error.what();
      }
    }
  }
}

TEST(DicomFuzz, BrokenSlicesGiveAWholeVolumeOrInvalidInput) {
  const TemporaryFolder folder;
  const auto slices = test::dicom_slices(even_volume());
  write_series(folder, slices);
  const auto& [name, slice] = *slices.begin();
  const std::string whole = test::dicom(slice);
  std::mt19937 random(5);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (int i = 0; i < 300; ++i) {
    std::string broken = whole;
    const std::size_t at = 132 + below(whole.size() - 132);
    switch (below(4)) {
      case 0:
        broken[at] = static_cast<char>(below(256));
        break;
      case 1:
        broken[at] ^= static_cast<char>(1U << below(8));
        break;
      case 2:
        broken.resize(at);
        break;
      default:
        broken.erase(at, 1 + below(6));
    }
    write_bytes(folder / name, broken);
    try {
      EXPECT_EQ(read_volume(folder.path()).values.size(), 140U);
    } catch (const InvalidInput&) {
    } catch (const std::exception& error) {
      FAIL() << "mutation " << i << " threw something else: " << error.what();
    }
  }
}

}  // namespace
}  // namespace arthronaut::images
