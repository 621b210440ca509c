// DICOMDIR: what the disc's own table of contents leads to is read, and nothing else.
#include "planning/images/dicom_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/files/atomic_file.h"
#include "planning/files/scalar_bytes.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_file.h"
#include "tests/message_of.h"
#include "tests/planning/images/enhanced_dicom.h"
#include "tests/planning/images/volume_forms.h"
#include "tests/temporary_folder.h"

namespace arthronaut::images {
namespace {

using test::message_of;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

// Two series of the same slices, of which the second holds other values.
class DicomDirectory : public testing::Test {
 protected:
  DicomDirectory() {
    Volume darker = test::oblique_volume();
    for (float& v : darker.values) v -= 10;
    std::vector<std::string> names;
    for (int k = 0; k < 4; ++k) {
      names.insert(names.end(), {"A" + std::to_string(3 - k), "B" + std::to_string(k)});
      test::write_listed_slice(disc_.path(), test::oblique_volume(),
                               {"A" + std::to_string(3 - k), "1.2.3.4", k});
      test::write_listed_slice(disc_.path(), darker, {"B" + std::to_string(k), "1.2.3.5", k});
    }
    test::write_dicom_directory(disc_.path(), names);
  }
  // Writes a number at the first element of group 4 with this number.
  void patch(std::uint16_t element, std::uint32_t value) const {
    std::string text = files::read_text(disc_ / "DICOMDIR");
    const std::string tag = test::bytes_of(std::uint16_t{4}, std::endian::little) +
                            test::bytes_of(element, std::endian::little) + "UL";
    const std::size_t at = text.find(tag);
    ASSERT_NE(at, std::string::npos);
    text.replace(at + 8, 4, test::bytes_of(value, std::endian::little));
    test::write_bytes(disc_ / "DICOMDIR", text);
  }

  TemporaryFolder disc_;
};

TEST_F(DicomDirectory, LeadsToItsImagesByItsNameAndByItsFolder) {
  for (const auto& source : {disc_.path(), disc_ / "DICOMDIR"}) {
    ASSERT_TRUE(is_volume_source(source));
    const Volume volume = read_volume(source, {"1.2.3.4"});
    const Volume expected = test::oblique_volume();
    ASSERT_EQ(volume.size, expected.size);
    EXPECT_EQ(volume.values, expected.values);
    // Positions of up to 130 mm are written as text of nine digits: half a digit is 5e-7 mm.
    EXPECT_LT((volume.lps_from_index.matrix() - expected.lps_from_index.matrix()).cwiseAbs().maxCoeff(),
              5e-7);
    EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(source); }),
                AllOf(HasSubstr("2 series"), HasSubstr("--series")));
  }
}

// A slice that is lying about beside the disc's own would be one too many.
TEST_F(DicomDirectory, WhatItDoesNotListIsNotRead) {
  test::write_listed_slice(disc_.path(), test::oblique_volume(), {"STRAY", "1.2.3.4", 2});
  EXPECT_EQ(read_volume(disc_.path(), {"1.2.3.4"}).values, test::oblique_volume().values);
}

TEST_F(DicomDirectory, NamesThatBecameSmallAreFound) {
  std::filesystem::rename(disc_ / "A2", disc_ / "a2");
  EXPECT_EQ(read_volume(disc_.path(), {"1.2.3.4"}).values, test::oblique_volume().values);
}

// A record's type that reaches over what follows it: DCMTK throws what is no error of its own there.
TEST_F(DicomDirectory, ATypeThatReachesTooFarIsRefusedWithItsPlace) {
  std::string text = files::read_text(disc_ / "DICOMDIR");
  const std::string tag = test::bytes_of(std::uint16_t{4}, std::endian::little) +
                          test::bytes_of(std::uint16_t{0x1430}, std::endian::little) + "CS";
  const std::size_t last = text.rfind(tag);
  ASSERT_NE(last, std::string::npos);
  text.replace(last + 6, 2, test::bytes_of(std::uint16_t{0x86}, std::endian::little));
  test::write_bytes(disc_ / "DICOMDIR", text);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(disc_.path(), {"1.2.3.4"}); }),
              AllOf(HasSubstr("DICOMDIR"), HasSubstr("broken or cut off")));
}

TEST_F(DicomDirectory, AFileThatIsNotThereIsNamed) {
  std::filesystem::remove(disc_ / "A2");
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(disc_.path(), {"1.2.3.4"}); }),
              AllOf(HasSubstr("DICOMDIR: "), HasSubstr("A2"), HasSubstr("not there")));
}

// (0004,1200) leads to the first record, (0004,1400) from one record to the next.
TEST_F(DicomDirectory, OneThatLeadsInCirclesOrNowhereIsRefused) {
  const std::string text = files::read_text(disc_ / "DICOMDIR");
  const std::string tag = test::bytes_of(std::uint16_t{4}, std::endian::little) +
                          test::bytes_of(std::uint16_t{0x1200}, std::endian::little) + "UL";
  const auto first = files::scalar_at<std::uint32_t>(text.data() + text.find(tag) + 8, std::endian::little);
  patch(0x1400, first);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(disc_.path()); }),
              AllOf(HasSubstr("DICOMDIR: record at byte " + std::to_string(first)), HasSubstr("twice")));
  patch(0x1400, 7);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(disc_.path()); }),
              HasSubstr("DICOMDIR: record at byte 7: is not there"));
  patch(0x1200, 0);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(disc_.path()); }),
              HasSubstr("lists no image"));
}

// It must not make this program read any file of the machine.
TEST_F(DicomDirectory, NamesOutsideOfTheDiscAreRefused) {
  std::string text = files::read_text(disc_ / "DICOMDIR");
  const std::string tag = std::string("CS\2\0", 4);
  const std::size_t at = text.find(tag + "A2");
  ASSERT_NE(at, std::string::npos);
  text.replace(at + tag.size(), 2, "..");
  test::write_bytes(disc_ / "DICOMDIR", text);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(disc_.path()); }),
              HasSubstr("not in its folder"));
}

}  // namespace
}  // namespace arthronaut::images
