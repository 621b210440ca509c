#include "planning/pacs/send.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/pacs/query.h"
#include "tests/planning/pacs/sent_series.h"

namespace arthronaut::pacs {
namespace {

namespace fs = std::filesystem;
using test::kImageCount;
using test::quick_connection;
using ::testing::HasSubstr;

std::string refusal_of(const std::vector<fs::path>& paths) {
  try {
    (void)files_to_send(paths);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(PacsSend, FilesAreLookedAtFirst) {
  const test::TemporaryFolder folder;
  test::write_dicom_series(folder / "ct", test::ellipsoid_ct());
  files::write_atomically(folder / "letter.txt", "Dear colleague");
  files::write_atomically(folder / "ct/letter.txt", "Dear colleague");  // passed over
  fs::create_directory(folder / "empty");
  EXPECT_EQ(files_to_send({folder / "ct"}).size(), std::size_t{kImageCount});
  // A study lies in a folder a series, as many programs write it.
  fs::create_directories(folder / "study/a/b");
  fs::rename(folder / "ct", folder / "study/a/b/ct");
  fs::create_directory_symlink(folder / "study", folder / "study/a/round");
  EXPECT_EQ(files_to_send({folder / "study"}).size(), std::size_t{kImageCount});
  fs::rename(folder / "study/a/b/ct", folder / "ct");
  EXPECT_THAT(refusal_of({folder / "study"}), HasSubstr("study: holds no DICOM file"));
  EXPECT_THAT(refusal_of({folder / "ct", folder / "letter.txt"}),
              HasSubstr("letter.txt: is not a DICOM file"));
  EXPECT_THAT(refusal_of({folder / "none"}), HasSubstr("none: does not exist"));
  EXPECT_THAT(refusal_of({folder / "empty"}), HasSubstr("holds no DICOM file"));
  EXPECT_THAT(refusal_of({folder / "ct", folder / "ct/slice1000.dcm"}), HasSubstr("the same object"));
  EXPECT_THAT(refusal_of({}), HasSubstr("nothing to send"));
}

TEST(PacsSend, StoresEachFileAndTellsHowFarItIs) {
  const test::Orthanc orthanc;
  const test::TemporaryFolder folder;
  test::write_dicom_series(folder / "ct", test::ellipsoid_ct());
  int last = 0;
  const auto summary = send_files(orthanc.peer(), quick_connection(), files_to_send({folder / "ct"}),
                                  {.asks_commitment = false}, [&](const TransferProgress& progress) {
                                    EXPECT_EQ(progress.done, ++last);
                                    EXPECT_EQ(progress.total, kImageCount);
                                  });
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::Stored);
  EXPECT_EQ(summary.commitment, Commitment::NotAsked);
  EXPECT_EQ(last, kImageCount);
  EXPECT_EQ(
      find(orthanc.peer(), quick_connection(), {.patient_id = "4711"}).patients[0].studies[0].image_count,
      kImageCount);
}

// What was looked at, and said to go, is what goes.
TEST(PacsSend, AFileThatWasChangedSinceIsNotSent) {
  const test::Orthanc orthanc;
  const test::TemporaryFolder folder;
  test::write_dicom_series(folder / "ct", test::ellipsoid_ct());
  const auto files = files_to_send({folder / "ct"});
  std::filesystem::copy_file(files[1].file, files[0].file, std::filesystem::copy_options::overwrite_existing);
  const auto summary = send_files(orthanc.peer(), quick_connection(), files, {.asks_commitment = false});
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::SomeRefused);
  EXPECT_FALSE(summary.files[0].is_stored);
  EXPECT_THAT(summary.files[0].note, ::testing::HasSubstr("was changed since it was looked at"));
  EXPECT_TRUE(summary.files[1].is_stored);
}

// The peer dies at one file and is back before the tries are over: no file is lost.
TEST(PacsSend, GoesOnAfterABrokenConnection) {
  test::Orthanc orthanc;
  const test::TemporaryFolder folder;
  test::write_dicom_series(folder / "ct", test::ellipsoid_ct());
  ConnectionOptions patient = quick_connection();
  patient.retries = 20;
  const auto summary = send_files(orthanc.peer(), patient, files_to_send({folder / "ct"}),
                                  {.asks_commitment = false}, [&](const TransferProgress& progress) {
                                    if (progress.done != 10) return;
                                    orthanc.kill();
                                    orthanc.start();
                                  });
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::Stored);
  EXPECT_EQ(
      find(orthanc.peer(), quick_connection(), {.patient_id = "4711"}).patients[0].studies[0].image_count,
      kImageCount);
}

TEST(PacsSend, StopsBetweenFiles) {
  const test::Orthanc orthanc;
  const test::TemporaryFolder folder;
  test::write_dicom_series(folder / "ct", test::ellipsoid_ct());
  std::stop_source stop;
  const auto summary = send_files(
      orthanc.peer(), quick_connection(), files_to_send({folder / "ct"}), {},
      [&](const TransferProgress& progress) {
        if (progress.done == 5) stop.request_stop();
      },
      stop.get_token());
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::Stopped);
  EXPECT_EQ(std::count_if(summary.files.begin(), summary.files.end(),
                          [](const SentFile& file) { return file.is_stored; }),
            5);
}

// An error is told as what it is: of the file on its way nobody knows, and those after it were never sent.
TEST(PacsSend, AnErrorInTheMiddleIsToldOfTheFileOnItsWay) {
  SendSummary summary;
  summary.files.resize(5);
  summary.files[0].is_stored = true;
  summary.files[1].note = "refused with A700";
  const DeviceError error("https://pacs: answers with HTTP 503");
  ASSERT_TRUE(end_broken_off(error, summary));
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::BrokenOff);
  EXPECT_EQ(summary.files[0].note, "");
  EXPECT_EQ(summary.files[1].note, "refused with A700");
  EXPECT_EQ(summary.files[2].note, "not confirmed: https://pacs: answers with HTTP 503");
  EXPECT_EQ(summary.files[3].note, "not sent");
  EXPECT_EQ(summary.files[4].note, "not sent");
  EXPECT_THAT(summary.commitment_note, ::testing::Not(HasSubstr("connection")));
  SendSummary nothing;
  nothing.files.resize(2);
  EXPECT_FALSE(end_broken_off(error, nothing));
}

}  // namespace
}  // namespace arthronaut::pacs
