// Enhanced CT and MR: one file, of which each frame says for itself where it lies.
#include "tests/planning/images/enhanced_dicom.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_file.h"
#include "tests/message_of.h"
#include "tests/planning/images/volume_forms.h"
#include "tests/temporary_folder.h"

namespace arthronaut::images {
namespace {

using test::EnhancedForm;
using test::message_of;
using test::TemporaryFolder;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

void expect_same(const Volume& found, const Volume& expected) {
  ASSERT_EQ(found.size, expected.size);
  // Positions of up to 130 mm are written as text of nine digits: half a digit is 5e-7 mm.
  EXPECT_LT((found.lps_from_index.matrix() - expected.lps_from_index.matrix()).cwiseAbs().maxCoeff(), 5e-7);
  EXPECT_EQ(found.values, expected.values);
}

std::string refusal(const EnhancedForm& form) {
  const TemporaryFolder folder;
  test::write_enhanced_dicom(folder / "knee.dcm", test::oblique_volume(), form);
  return message_of<InvalidInput>([&] { (void)read_volume(folder / "knee.dcm"); });
}

DcmItem& groups_of_frame(DcmDataset& dataset, long frame) {
  DcmItem* item = nullptr;
  dataset.findAndGetSequenceItem(DCM_PerFrameFunctionalGroupsSequence, item, frame);
  return *item;
}

// Each frame with an orientation of its own, of which the third's is another.
void turn_frames(DcmDataset& dataset, bool instead_of_shared) {
  if (instead_of_shared) {
    DcmItem* shared = nullptr;
    dataset.findAndGetSequenceItem(DCM_SharedFunctionalGroupsSequence, shared);
    delete shared->remove(DCM_PlaneOrientationSequence);
  }
  for (long frame = 0; frame < 4; ++frame) {
    DcmItem* orientation = nullptr;
    groups_of_frame(dataset, frame).findOrCreateSequenceItem(DCM_PlaneOrientationSequence, orientation);
    orientation->putAndInsertString(DCM_ImageOrientationPatient,
                                    frame == 2 ? "1\\0\\0\\0\\0\\-1" : "1\\0\\0\\0\\1\\0");
  }
}

// Frames in no order, each with its own place and rescaling; an oblique grid; by the file and by its folder.
TEST(EnhancedDicom, FramesLieWhereTheirGroupsSay) {
  const TemporaryFolder folder;
  test::write_enhanced_dicom(folder / "knee.dcm", test::oblique_volume());
  ASSERT_TRUE(is_volume_source(folder / "knee.dcm"));
  const Volume volume = read_volume(folder / "knee.dcm");
  EXPECT_EQ(volume.modality, Modality::Ct);
  expect_same(volume, test::oblique_volume());
  expect_same(read_volume(folder.path()), test::oblique_volume());
}

// DCMTK's codecs, on the pixels that DCMTK's encoders made without loss. JPEG-LS is read in the tests on real
// data: its encoder writes beyond its buffer for pictures as small as these.
TEST(EnhancedDicom, EveryTransferSyntaxGivesTheSameVoxels) {
  for (const char* syntax : {UID_LittleEndianImplicitTransferSyntax, UID_BigEndianExplicitTransferSyntax,
                             UID_DeflatedExplicitVRLittleEndianTransferSyntax, UID_RLELosslessTransferSyntax,
                             UID_JPEGProcess14SV1TransferSyntax, UID_JPEGProcess14TransferSyntax}) {
    SCOPED_TRACE(syntax);
    const TemporaryFolder folder;
    test::write_enhanced_dicom(folder / "knee.dcm", test::oblique_volume(), {.transfer_syntax = syntax});
    expect_same(read_volume(folder / "knee.dcm"), test::oblique_volume());
  }
}

// Two echoes of each slice in one file: the first is taken, and it is said.
TEST(EnhancedDicom, OfSeveralEchoesTheFirstIsTakenAndSaid) {
  const TemporaryFolder folder;
  test::write_enhanced_dicom(folder / "knee.dcm", test::oblique_volume(),
                             {.modality = "MR",
                              .slices = {0, 0, 1, 1, 2, 2, 3, 3},
                              .echo_times_ms = {12.5, 40, 12.5, 40, 12.5, 40, 12.5, 40}});
  const Volume volume = read_volume(folder / "knee.dcm");
  EXPECT_EQ(volume.modality, Modality::Mr);
  expect_same(volume, test::oblique_volume());
  EXPECT_THAT(volume.notes, Contains(AllOf(HasSubstr("2 echoes"), HasSubstr("12.5 ms"))));
}

TEST(EnhancedDicom, TheFramesAnatomyTellsTheSide) {
  const test::TemporaryFolder folder;
  const auto side_by = [&](const DcmTagKey& groups) {
    test::EnhancedForm form;
    form.change = [&](DcmDataset& dataset) {
      DcmItem *item = nullptr, *anatomy = nullptr;
      ASSERT_TRUE(dataset.findOrCreateSequenceItem(groups, item).good());
      ASSERT_TRUE(item->findOrCreateSequenceItem(DCM_FrameAnatomySequence, anatomy).good());
      ASSERT_TRUE(anatomy->putAndInsertString(DCM_FrameLaterality, "L").good());
    };
    test::write_enhanced_dicom(folder / "knee.dcm", test::oblique_volume(), form);
    return read_volume(folder / "knee.dcm").side;
  };
  EXPECT_EQ(side_by(DCM_SharedFunctionalGroupsSequence), bones::Side::Left);
  EXPECT_EQ(side_by(DCM_PerFrameFunctionalGroupsSequence), bones::Side::Left) << "of the first frame alone";
}

TEST(EnhancedDicom, OddFramesAreRefusedByNumber) {
  EXPECT_THAT(refusal({.slices = {0, 1, 3}}), AllOf(HasSubstr("knee.dcm: frame "), HasSubstr("missing")));
  EXPECT_THAT(refusal({.slices = {0, 1, 1, 2, 3}}), HasSubstr("same place"));
  EXPECT_THAT(refusal({.change =
                           [](DcmDataset& dataset) {
                             delete groups_of_frame(dataset, 1).remove(DCM_PlanePositionSequence);
                           }}),
              AllOf(HasSubstr("frame 2: "), HasSubstr("where it lies")));
  EXPECT_THAT(refusal({.change = [](DcmDataset& dataset) { turn_frames(dataset, false); }}),
              HasSubstr("both for itself and for all"));
  EXPECT_THAT(refusal({.change = [](DcmDataset& dataset) { turn_frames(dataset, true); }}),
              AllOf(HasSubstr("frame 3: "), HasSubstr("angle")));
  EXPECT_THAT(
      refusal({.change = [](DcmDataset& dataset) { dataset.putAndInsertString(DCM_NumberOfFrames, "5"); }}),
      HasSubstr("functional groups"));
}

// Several frames and no word of where they lie, as of an ultrasound: no guess.
TEST(EnhancedDicom, FramesWithoutGroupsAreRefused) {
  EXPECT_THAT(
      refusal({.change =
                   [](DcmDataset& dataset) { delete dataset.remove(DCM_PerFrameFunctionalGroupsSequence); }}),
      AllOf(HasSubstr("4 frames"), HasSubstr("where each lies")));
}

TEST(EnhancedDicom, PixelsCutOffAreRefused) {
  const TemporaryFolder folder;
  test::write_enhanced_dicom(folder / "knee.dcm", test::oblique_volume());
  const std::string whole = files::read_text(folder / "knee.dcm");
  for (int tenth = 0; tenth < 10; ++tenth) {
    test::write_bytes(folder / "knee.dcm",
                      whole.substr(0, whole.size() * static_cast<std::size_t>(tenth) / 10));
    EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder.path()); }),
                HasSubstr(folder.path().string()))
        << tenth;
  }
  test::write_bytes(folder / "knee.dcm", whole.substr(0, whole.size() - 1));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder.path()); }),
              HasSubstr("knee.dcm: byte "));
}

// A volume that is whole, or InvalidInput, and nothing else.
TEST(EnhancedDicom, BrokenFilesGiveAWholeVolumeOrInvalidInput) {
  const TemporaryFolder folder;
  for (const char* syntax : {UID_LittleEndianExplicitTransferSyntax, UID_RLELosslessTransferSyntax,
                             UID_JPEGProcess14SV1TransferSyntax}) {
    test::write_enhanced_dicom(folder / "knee.dcm", test::oblique_volume(), {.transfer_syntax = syntax});
    const std::string whole = files::read_text(folder / "knee.dcm");
    std::mt19937 random(11);
    const auto below = [&](std::size_t n) {
      return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
    };
    for (int i = 0; i < 250; ++i) {
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
      test::write_bytes(folder / "knee.dcm", broken);
      try {
        const Volume volume = read_volume(folder.path());
        ASSERT_EQ(volume.values.size(), static_cast<std::size_t>(volume.size.cast<std::int64_t>().prod()));
        for (const float v : volume.values) ASSERT_TRUE(std::isfinite(v)) << i;
      } catch (const InvalidInput&) {
      } catch (const std::exception& error) {
        FAIL() << syntax << ", mutation " << i << " threw something else: " << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace arthronaut::images
