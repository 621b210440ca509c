// pacs against a real PACS: what it prints, what it leaves behind, killed and started again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <random>

#include "planning/cases/case.h"
#include "planning/cases/identity.h"
#include "planning/files/atomic_file.h"
#include "planning/phantom/phantom_case.h"
#include "tests/app/command_line/program.h"
#include "tests/planning/pacs/sent_series.h"
#include "tests/resources/described.h"

namespace arthronaut {
namespace {

namespace fs = std::filesystem;
using test::kImageCount;
using test::run_program;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class PacsCommand : public ::testing::Test {
 protected:
  PacsCommand() { test::write_and_send(orthanc_, made_ / "ct"); }
  [[nodiscard]] std::string peer() const { return pacs::to_text(orthanc_.peer()); }
  [[nodiscard]] test::ProgramResult run(std::vector<std::string> arguments,
                                        const test::ProgramLimits& limits = {}) const {
    arguments.insert(arguments.begin(), "pacs");
    arguments.insert(arguments.end(), {"--peer", peer(), "--retries", "0"});
    return run_program(arguments, limits);
  }
  [[nodiscard]] test::ProgramResult get(const test::ProgramLimits& limits = {}) const {
    return run({"get", "--series", series_, "-o", got_ / "scan"}, limits);
  }
  // Images that were fetched into a folder that is not whole yet.
  [[nodiscard]] int waiting_images() const {
    std::error_code vanished;  // a file that is given its name meanwhile
    int count = 0;
    for (fs::recursive_directory_iterator entry(got_.path(), vanished), end; !vanished && entry != end;
         entry.increment(vanished))
      count += entry->path().extension() == ".dcm" ? 1 : 0;
    return count;
  }
  // Killed once so many images wait; true when it came to its end before that.
  [[nodiscard]] bool get_until_killed(int images) const {
    return get({.interrupts_when = [&] { return waiting_images() >= images; }, .interrupted_by = SIGKILL})
               .exit_code == 0;
  }

  const test::Orthanc orthanc_;
  const test::TemporaryFolder made_, got_;
  const std::string series_ = test::DicomSeriesForm{}.origin.series_uid;
};

TEST_F(PacsCommand, FindsFetchesAndSends) {
  EXPECT_THAT(run({"echo"}).output, HasSubstr(peer() + " answers"));
  const auto words = run({"find", "--patient", "4711"});
  EXPECT_EQ(words.exit_code, 0);
  EXPECT_THAT(words.output,
              AllOf(HasSubstr("Muster^Anna, ID 4711"), HasSubstr("44 images"), HasSubstr(series_)));
  const auto found = nlohmann::json::parse(run({"find", "--patient", "4711", "--json"}).output);
  EXPECT_EQ(test::undescribed(found, "pacs_find"), "");
  EXPECT_EQ(found["complete"], true);
  const auto& study = found["patients"][0]["studies"][0];
  EXPECT_EQ(study["images"], kImageCount);
  EXPECT_EQ(study["series"][0]["uid"], series_);
  EXPECT_EQ(study["series"][0]["images"], kImageCount);

  const auto got = run({"get", "--series", series_, "-o", got_ / "scan", "--json"});
  ASSERT_EQ(got.exit_code, 0) << got.errors;
  const auto fetched = nlohmann::json::parse(got.output);
  EXPECT_EQ(test::undescribed(fetched, "pacs_get"), "");
  EXPECT_EQ(fetched["images"], kImageCount);
  EXPECT_EQ(fetched["way"], "C-GET");
  EXPECT_TRUE(fetched["planned_cases"].empty());
  const fs::path case_folder = made_ / "data/arthronaut/cases/hers.arthro";
  cases::save_case(case_folder,
                   phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "Her knee"));
  cases::save_identity(case_folder, {"Muster^Anna", "4711", "19900131"});
  const auto again = nlohmann::json::parse(
      run({"get", "--series", series_, "-o", got_ / "scan", "--json"}, {.data_home = made_ / "data"}).output);
  EXPECT_EQ(test::undescribed(again, "pacs_get"), "");
  const nlohmann::json hers = {{{"name", "Her knee"}, {"folder", case_folder.string()}}};
  EXPECT_EQ(again.at("planned_cases"), hers);
  EXPECT_THAT(got_.names(), ElementsAre("scan"));
  EXPECT_EQ(test::pixels_of(got_ / "scan"), test::pixels_of(made_ / "ct"));

  const auto sent = run({"send", got_ / "scan", "--json", "--commitment-wait-s", "0"});
  ASSERT_EQ(sent.exit_code, 0) << sent.errors;
  const auto stored = nlohmann::json::parse(sent.output);
  EXPECT_EQ(test::undescribed(stored, "pacs_send"), "");
  EXPECT_EQ(stored["stored"], true);
  EXPECT_EQ(stored["commitment"], "awaited");
  EXPECT_EQ(stored["files"].size(), std::size_t{kImageCount});
  // The fetched series goes the way of any other.
  EXPECT_THAT(run_program({"series", got_ / "scan"}).output, HasSubstr("UID " + series_));
}

TEST_F(PacsCommand, CommitmentCanBeRequired) {
  const auto sent =
      run({"send", made_ / "ct/slice1000.dcm", "--commitment-wait-s", "0", "--require-commitment"});
  EXPECT_EQ(sent.exit_code, 4);
  EXPECT_THAT(sent.errors, HasSubstr("storage commitment is awaited"));
}

TEST_F(PacsCommand, SaysWhatIsWrong) {
  const auto nothing = run({"find", "--patient", "NOBODY", "--json"});
  EXPECT_EQ(nothing.exit_code, 0);
  EXPECT_THAT(nlohmann::json::parse(nothing.output)["patients"], testing::IsEmpty());
  EXPECT_THAT(nothing.errors, HasSubstr("has nothing of the kind"));
  EXPECT_EQ(run({"find", "--patient", "NOBODY", "--quiet"}).errors, "");
  const auto unknown = run({"get", "--series", "1.2.3", "-o", got_ / "scan"});
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_THAT(unknown.errors, HasSubstr("has no series 1.2.3"));
  EXPECT_THAT(run({"get", "--series", "knee", "-o", got_ / "scan"}).errors, HasSubstr("no UID"));
  EXPECT_EQ(run_program({"pacs", "echo", "--peer", "127.0.0.1:104"}).exit_code, 2);
  EXPECT_THAT(run_program({"pacs", "echo", "--peer", "127.0.0.1:104"}).errors, HasSubstr("has no AE title"));
  EXPECT_EQ(run_program({"pacs", "echo", "--peer", peer(), "--tls"}).exit_code, 2);
  EXPECT_EQ(run_program({"pacs"}).exit_code, 2);
  const auto letter = run({"send", "/etc/hostname"});
  EXPECT_EQ(letter.exit_code, 3);
  EXPECT_THAT(letter.errors, HasSubstr("/etc/hostname: is not a DICOM file"));
  EXPECT_THAT(got_.names(), ElementsAre());
}

// The same verbs and answers, by the other way; the password stands on no command line.
TEST(PacsWebCommand, FindsFetchesAndSends) {
  const test::Orthanc orthanc({.offers_web = true});
  const test::TemporaryFolder made, got;
  test::write_dicom_series(made / "ct", test::ellipsoid_ct());
  const std::string series = test::DicomSeriesForm{}.origin.series_uid;
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "pacs");
    arguments.insert(arguments.end(), {"--web", orthanc.web_url(), "--retries", "0"});
    return run_program(arguments);
  };
  EXPECT_THAT(run({"echo"}).output, HasSubstr(orthanc.web_url() + " answers"));
  const auto sent = nlohmann::json::parse(run({"send", made / "ct", "--json"}).output);
  EXPECT_EQ(sent["stored"], true);
  EXPECT_EQ(sent["commitment"], "not supported");
  EXPECT_EQ(sent["peer"], orthanc.web_url());
  EXPECT_THAT(run({"find", "--patient", "4711"}).output, AllOf(HasSubstr("44 images"), HasSubstr(series)));
  const auto fetched =
      nlohmann::json::parse(run({"get", "--series", series, "-o", got / "scan", "--json"}).output);
  EXPECT_EQ(fetched["way"], "WADO-RS");
  EXPECT_EQ(fetched["images"], kImageCount);
  EXPECT_EQ(run({"get", "--series", "1.2.3", "-o", got / "none"}).exit_code, 3);
  EXPECT_EQ(run({"echo", "--peer", "PACS@host:104"}).exit_code, 2);
  EXPECT_EQ(run({"echo", "--user", "me"}).exit_code, 2);  // http
  EXPECT_EQ(run_program({"pacs", "echo", "--web", "ftp://host"}).exit_code, 2);
}

TEST_F(PacsCommand, AFullDiskLeavesNothingHalf) {
  const auto full = get({.file_size_bytes = 2000, .as_nobody = false});
  EXPECT_EQ(full.exit_code, 3);
  EXPECT_THAT(full.errors,
              AllOf(HasSubstr((got_ / "scan").string() + ": cannot be written to"), HasSubstr("too large")));
  EXPECT_THAT(got_.names(), ElementsAre());
  EXPECT_EQ(get().exit_code, 0);
}

TEST_F(PacsCommand, AReadOnlyFolderIsToldBeforeAnythingIsFetched) {
  const auto refused = get({.file_size_bytes = 0, .as_nobody = true});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.errors, AllOf(HasSubstr((got_ / "scan").string()), HasSubstr("Permission denied")));
  EXPECT_THAT(got_.names(), ElementsAre());
}

// Killed at twenty moments: there is never a folder that lacks an image, what waits is whole but for the one
// image that was being written, and the same command brings the rest. A moment is a number of images, since
// how long the program starts and the transfer takes is the machine's matter.
TEST_F(PacsCommand, IsKilledAtAnyMomentAndGoesOn) {
  std::mt19937 random(20261122);
  std::uniform_int_distribution<int> images(0, kImageCount - 1);
  const auto made = test::pixels_of(made_ / "ct");
  int cut_off = 0;
  for (int i = 0; i < 20; ++i) {
    const bool is_done = get_until_killed(images(random));
    const bool has_folder = fs::exists(got_ / "scan");
    EXPECT_TRUE(has_folder || !is_done);
    if (has_folder) {
      EXPECT_EQ(test::pixels_of(got_ / "scan"), made);
    }
    cut_off += !has_folder && waiting_images() > 0 ? 1 : 0;
    ASSERT_EQ(get().exit_code, 0);
    EXPECT_EQ(test::pixels_of(got_ / "scan"), made);
    EXPECT_THAT(got_.names(), ElementsAre("scan"));
    fs::remove_all(got_ / "scan");
  }
  EXPECT_GT(cut_off, 0) << "no moment was in the middle of the transfer";
}

}  // namespace
}  // namespace arthronaut
