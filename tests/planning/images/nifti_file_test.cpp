// How a NIfTI file lies in the patient: its two forms, and which of them is believed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "planning/images/volume_file.h"
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

// The size of a bone is the patient's, not an atlas's.
class NiftiScale : public ::testing::Test {
 protected:
  // Codes of both forms, and the sform's columns scaled; the qform is the volume's own.
  [[nodiscard]] std::filesystem::path write(int sform_code, int qform_code, double sform_scale) const {
    images::Volume stretched = test::oblique_volume();
    stretched.lps_from_index.linear() *= sform_scale;
    const std::string sform = test::nifti(stretched, std::endian::little);
    std::string both = test::nifti(test::oblique_volume(), std::endian::little, true);
    both.replace(280, 48, sform.substr(280, 48));
    both[252] = static_cast<char>(qform_code);
    both[254] = static_cast<char>(sform_code);
    write_bytes(folder_ / "a.nii", both);
    return folder_ / "a.nii";
  }
  const TemporaryFolder folder_;
};

TEST_F(NiftiScale, AnAtlasGivesWayToTheScanner) {
  for (const int atlas : {3, 4, 5}) expect_same(read_volume(write(atlas, 1, 1.2)), test::oblique_volume());
  expect_same(read_volume(write(4, 2, 1.2)), test::oblique_volume());
}

TEST_F(NiftiScale, AnAtlasAloneIsRefused) {
  for (const auto& [sform, qform] : {std::pair(4, 0), std::pair(3, 4), std::pair(0, 4)})
    EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(write(sform, qform, 1)); }),
                AllOf(HasSubstr("a.nii"), HasSubstr("form_code"), HasSubstr("atlas")));
}

TEST_F(NiftiScale, AFormThatIsStretchedIsRefusedWithBothSizes) {
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(write(1, 1, 1.2)); }),
              AllOf(HasSubstr("a.nii: sform"), HasSubstr("0.6 along axis 1"), HasSubstr("pixdim of 0.5")));
  EXPECT_THROW((void)read_volume(write(2, 1, 0.98)), InvalidInput);
  EXPECT_NO_THROW((void)read_volume(write(1, 0, 1.002)));  // rounding
}

}  // namespace
}  // namespace arthronaut::images
