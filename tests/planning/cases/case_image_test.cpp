// The images of a case: what was stored is what is loaded, and a case from elsewhere reads nothing but its
// own.
#include "planning/cases/case_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/cases/case.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/planning/images/volume_forms.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

using test::message_of;
using test::TemporaryFolder;
using testing::HasSubstr;

Case case_with_image(const std::filesystem::path& folder, const images::Volume& volume) {
  Case contents;
  contents.name = "Knee";
  CaseImage image{.file = {},
                  .modality = "CT",
                  .source = "DICOM",
                  .size = volume.size,
                  .spacing_mm = volume.spacing_mm()};
  store_image(folder, 1, images::encoded(volume), image);
  contents.images.push_back(image);
  save_case(folder, contents);
  return contents;
}

TEST(CaseImage, ComesBackAsItWasStored) {
  for (const float shift : {0.0F, 1000.0F, 0.25F}) {  // 16 bits, bytes, floats
    const TemporaryFolder folder;
    images::Volume volume = test::oblique_volume();
    volume.modality_in_file = "CT";
    for (float& v : volume.values)
      v = shift == 1000.0F ? static_cast<float>(int(v + shift) % 256) : v + shift;
    (void)case_with_image(folder.path(), volume);
    const Case loaded = load_case(folder.path());
    ASSERT_EQ(loaded.images.size(), 1U);
    const images::Volume there = load_image(folder.path(), loaded.images[0]);
    EXPECT_EQ(there.values, volume.values);
    EXPECT_EQ(there.size, volume.size);
    EXPECT_EQ(there.lps_from_index.matrix(), volume.lps_from_index.matrix());  // 17 digits: to the bit
    EXPECT_EQ(there.modality, images::Modality::Ct);
    EXPECT_EQ(there.format, "DICOM");
  }
}

// A plan that is saved keeps the images; a case of an older version has none and opens.
TEST(CaseImage, SavingTheCaseKeepsThemAndOlderCasesHaveNone) {
  const TemporaryFolder folder;
  (void)case_with_image(folder.path(), test::oblique_volume());
  save_case(folder.path(), load_case(folder.path()));
  EXPECT_EQ(load_case(folder.path()).images.size(), 1U);
  files::write_atomically(folder / "case.json",
                          "{\"format\": \"arthronaut.case\", \"version\": 1, \"name\": \"Knee\", \"side\": "
                          "\"left\", \"bones\": []}");
  EXPECT_TRUE(load_case(folder.path()).images.empty());
}

TEST(CaseImage, OneThatIsGoneOrAnotherIsSaid) {
  const TemporaryFolder folder;
  Case contents = case_with_image(folder.path(), test::oblique_volume());
  contents.images[0].size.x() = 8;
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)load_image(folder.path(), contents.images[0]); }),
              HasSubstr("another volume"));
  std::filesystem::remove(folder / "images/1.nrrd");
  EXPECT_THAT(message_of<IoError>([&] { (void)load_image(folder.path(), contents.images[0]); }),
              HasSubstr("lost its images"));
}

TEST(CaseImage, AFileOutsideOfTheCaseIsRefused) {
  for (const std::string name : {"../1.nrrd", "/etc/passwd", "images/../../1.nrrd", "images/..", "1.nrrd"}) {
    const TemporaryFolder folder;
    (void)case_with_image(folder.path(), test::oblique_volume());
    std::string text = files::read_text(folder / "case.json");
    text.replace(text.find("images/1.nrrd"), 13, name);
    files::write_atomically(folder / "case.json", text);
    EXPECT_THAT(message_of<InvalidInput>([&] { (void)load_case(folder.path()); }),
                HasSubstr("images[0].file"))
        << name;
  }
}

}  // namespace
}  // namespace arthronaut::cases
