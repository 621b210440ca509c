// `arthronaut series`: what images::find_series says of a folder, and a message where the folder is not to be
// read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "planning/cases/case.h"
#include "planning/cases/identity.h"
#include "planning/images/series_list.h"
#include "planning/phantom/phantom_case.h"
#include "tests/app/command_line/program.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/planning/images/large_volume.h"
#include "tests/planning/images/volume_forms.h"
#include "tests/resources/described.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::AllOf;
using ::testing::HasSubstr;

class SeriesCommand : public ::testing::Test {
 protected:
  SeriesCommand() {
    std::filesystem::create_directories(folder_ / "disc");
    for (const auto& [name, slice] : test::dicom_slices(test::oblique_volume()))
      test::write_bytes(folder_ / "disc" / name, test::dicom(slice));
    test::write_bytes(folder_ / "disc" / "broken.nrrd", "NRRD0004\n");
    test::write_bytes(folder_ / "disc" / "readme.txt", "hello");
  }
  const test::TemporaryFolder folder_;
};

TEST_F(SeriesCommand, WritesTheListAsJson) {
  const auto result = run_program({"series", folder_ / "disc", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto document = nlohmann::json::parse(result.output);
  const images::SeriesList list = images::find_series(folder_ / "disc");
  EXPECT_EQ(test::undescribed(document, "series"), "");
  EXPECT_EQ(document.at("other_files"), 1);
  ASSERT_EQ(document.at("series").size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& written = document["series"][i];
    const images::ImageSeries& series = list.series[i];
    EXPECT_EQ(written.at("uid"), series.uid);
    EXPECT_EQ(written.at("modality"), series.modality);
    EXPECT_EQ(written.at("description"), series.description);
    EXPECT_EQ(written.at("images"), series.image_count);
    EXPECT_EQ(written.at("readable"), series.is_readable());
    EXPECT_EQ(written.at("files").size(), series.files.size());
    EXPECT_EQ(written.at("spacing_mm").is_null(), !series.is_readable()) << "where nobody knows it";
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(written.at("size").at(static_cast<std::size_t>(axis)), series.size[axis]);
      if (!series.is_readable()) continue;
      EXPECT_EQ(written.at("spacing_mm").at(static_cast<std::size_t>(axis)), series.spacing_mm[axis]);
    }
    const std::string& wrong = series.is_readable() ? series.warnings.at(0) : series.refusal;
    EXPECT_EQ(written.at("wrong").at(0), wrong);
  }
}

TEST_F(SeriesCommand, SaysTheListInWords) {
  const auto result = run_program({"series", folder_ / "disc"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(
      result.output,
      AllOf(HasSubstr("CT series 3\n    UID 1.2.3.4\n    4 images; 7 x 5 x 4 voxels of"),
            HasSubstr("\"broken.nrrd\""), HasSubstr("cannot be opened: "), HasSubstr("1 other file")));
}

// Images of a patient whose case has a plan may be those after its operation.
TEST_F(SeriesCommand, SaysOfWhichCaseTheImagesMayBeAfterTheOperation) {
  test::write_dicom_series(folder_ / "after", test::ellipsoid_ct());  // Muster^Anna, 4711
  auto knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "Her knee");
  const std::filesystem::path cases = folder_ / "data/arthronaut/cases";
  for (const auto& [name, patient_id] : {std::pair{"hers.arthro", "4711"}, {"his.arthro", "1234"}}) {
    cases::save_case(cases / name, knee);
    cases::save_identity(cases / name, {"Muster^Anna", patient_id, "19900131"});
  }
  const auto result = run_program({"series", folder_ / "after"}, {.data_home = folder_ / "data"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("the case \"Her knee\" is of this patient and has a plan"),
                                   HasSubstr("arthronaut compare " + (cases / "hers.arthro").string() +
                                             " --postop " + (folder_ / "after").string() + " --series "),
                                   ::testing::Not(HasSubstr("his.arthro"))));
  const auto as_json = run_program({"series", folder_ / "after", "--json"}, {.data_home = folder_ / "data"});
  const auto document = nlohmann::json::parse(as_json.output);
  EXPECT_EQ(test::undescribed(document, "series"), "");
  const nlohmann::json hers = {{{"name", "Her knee"}, {"folder", (cases / "hers.arthro").string()}}};
  EXPECT_EQ(document.at("series").at(0).at("planned_cases"), hers) << document;
}

// As of an import: the reason on standard error, exit code 3, nothing on standard output.
TEST_F(SeriesCommand, WhatCannotBeLookedIntoIsSaid) {
  const auto expect_refused = [](const std::vector<std::string>& arguments, const std::string& reason) {
    const auto result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.errors, HasSubstr(reason));
    EXPECT_EQ(result.output, "");
  };
  expect_refused({"series", folder_ / "absent"}, "absent: does not exist");
  expect_refused({"series", folder_ / "disc" / "readme.txt"}, "readme.txt: is no folder and no volume");
  // Of one file there is nothing else to list.
  expect_refused({"series", folder_ / "disc" / "broken.nrrd"}, "broken.nrrd: cannot be opened: ");
  expect_refused({"series", folder_ / "disc" / "broken.nrrd", "--json"}, "broken.nrrd: cannot be opened: ");
  // Without memory for the files' own codecs: the folder is named, and the program ends as it should.
  expect_refused({"series", folder_ / "disc", "--memory-limit-gib", "0.001"},
                 (folder_ / "disc").string() + ": ");
  EXPECT_EQ(run_program({"series", folder_ / "disc", "--memory-limit-gib", "0"}).exit_code, 2);
}

// On a terminal one line says how far an import is as a whole: it does not begin anew with each stage.
TEST(ImportCommand, ItsProgressNeverGoesBack) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "knee.nrrd", test::uniform_nrrd({100, 100, 100}, 700));
  const auto result = run_program({"import", folder / "knee.nrrd", "--threshold", "300", "--side", "left",
                                   "--bone", "femur", "-o", folder / "Knee.arthro"},
                                  {.errors_on_terminal = true});
  const std::regex percent("([0-9]+) %");
  int before = 0, count = 0;
  for (std::sregex_iterator at(result.errors.begin(), result.errors.end(), percent), end; at != end; ++at) {
    const int now = std::stoi((*at)[1]);
    EXPECT_GE(now, before) << result.errors;
    before = now;
    ++count;
  }
  EXPECT_GE(count, 3) << result.errors;
  EXPECT_GE(before, 80) << result.errors;
}

}  // namespace
}  // namespace arthronaut
