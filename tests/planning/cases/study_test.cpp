#include "planning/cases/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

namespace fs = std::filesystem;
using bones::BoneKind;
using ::testing::HasSubstr;

images::DicomOrigin example(const std::string& series_uid) {
  return {.study_uid = "1.2.3",
          .study_id = "K17",
          .accession_number = "A-0815",
          .referring_physician = "Häuser^Eva",
          .study_date = "20260130",
          .study_time = "081500.25",
          .patient_sex = "F",
          .patient_id_issuer = "Clinic",
          .series_uid = series_uid,
          .frame_of_reference_uid = "1.2.3.9",
          .sop_class_uid = "1.2.840.10008.5.1.4.1.1.2",
          .sop_instance_uids = {series_uid + ".1", series_uid + ".2"}};
}

TEST(Study, OfEachBoneComesBack) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(load_studies(folder.path()).empty());
  const Studies same{{BoneKind::Femur, example("1.2.3.4")}, {BoneKind::Tibia, example("1.2.3.4")}};
  save_studies(folder.path(), same);
  EXPECT_EQ(load_studies(folder.path()), same);
  const Studies different{{BoneKind::Femur, example("1.2.3.4")}, {BoneKind::Tibia, example("1.2.3.5")}};
  save_studies(folder.path(), different);
  EXPECT_EQ(load_studies(folder.path()), different);
  const ImageStudies of_images{{"images/1.nrrd", example("1.2.3.4")}, {"images/2.nrrd", example("1.2.3.5")}};
  save_studies(folder.path(), different, of_images);
  EXPECT_EQ(load_studies(folder.path()), different);
  EXPECT_EQ(load_image_studies(folder.path()), of_images);
  save_studies(folder.path(), {});
  EXPECT_TRUE(folder.names().empty());
}

// The images of a CT are listed once for both bones.
TEST(Study, OfBothBonesStandsOnceInTheFile) {
  const test::TemporaryFolder folder;
  save_studies(folder.path(), {{BoneKind::Femur, example("1.2.3.4")}, {BoneKind::Tibia, example("1.2.3.4")}});
  const std::string text = files::read_text(study_file(folder.path()));
  EXPECT_EQ(text.find("1.2.3.4.2"), text.rfind("1.2.3.4.2"));
}

// Hazard 19: it leads to the patient as his name does.
TEST(Study, Hazard19IsItsOwnersAloneEvenInAnOpenFolder) {
  const mode_t before = ::umask(0);
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "open");
  save_studies(folder / "open", {{BoneKind::Femur, example("1.2.3.4")}});
  ::umask(before);
  EXPECT_EQ(fs::status(study_file(folder / "open")).permissions() & fs::perms::mask, fs::perms{0600});
}

TEST(Study, ABrokenFileIsSaid) {
  const test::TemporaryFolder folder;
  save_studies(folder.path(), {{BoneKind::Femur, example("1.2.3.4")}});
  std::string text = files::read_text(study_file(folder.path()));
  text.replace(text.find("\"femur\""), 7, "\"humerus\"");
  files::write_atomically(study_file(folder.path()), std::string_view(text));
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)load_studies(folder.path()); }),
              testing::AllOf(HasSubstr("study.json: studies[0].bones"), HasSubstr("no bone")));
}

}  // namespace
}  // namespace arthronaut::cases
