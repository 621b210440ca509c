#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/pacs/send.h"
#include "tests/planning/pacs/sent_series.h"

namespace arthronaut::pacs {
namespace {

using test::quick_connection;
using ::testing::HasSubstr;

SendSummary sent(const test::Orthanc& orthanc, int listening_port, double wait_s) {
  const test::TemporaryFolder folder;
  test::write_dicom_series(folder / "ct", test::ellipsoid_ct());
  ConnectionOptions connection = quick_connection();
  connection.listening_port = listening_port;
  return send_files(orthanc.peer(), connection, files_to_send({folder / "ct"}),
                    {.commitment_wait_s = wait_s});
}

// Orthanc reports on a connection of its own.
TEST(PacsCommitment, IsConfirmedWhereThePeerCanCallBack) {
  const int our_port = test::free_port();
  const test::Orthanc orthanc({.our_port = our_port});
  const auto summary = sent(orthanc, our_port, 20);
  EXPECT_EQ(summary.commitment, Commitment::Confirmed) << summary.commitment_note;
  for (const SentFile& file : summary.files) EXPECT_TRUE(file.is_committed) << file.file;
}

TEST(PacsCommitment, IsAwaitedWhereItCannot) {
  const test::Orthanc orthanc;
  const auto summary = sent(orthanc, 0, 1);
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::Stored);
  EXPECT_EQ(summary.commitment, Commitment::Awaited);
  EXPECT_THAT(summary.commitment_note, HasSubstr("give a port to listen at"));
  EXPECT_FALSE(summary.files.front().is_committed);
}

// Whatever comes of the request: what is stored is stored, and its account is not lost with it.
TEST(PacsCommitment, APortThatIsTakenLosesNothingOfTheAccount) {
  const test::Orthanc orthanc, elsewhere;
  const auto summary = sent(orthanc, elsewhere.peer().port, 1);
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::Stored);
  for (const SentFile& file : summary.files) EXPECT_TRUE(file.is_stored) << file.file;
  EXPECT_EQ(summary.commitment, Commitment::NotAsked);
  EXPECT_THAT(summary.commitment_note, HasSubstr("could not be asked for: "));
}

// Orthanc commits itself to those alone whom it knows.
TEST(PacsCommitment, IsSaidNotToBeHad) {
  const test::Orthanc orthanc({.knows_us = false});
  const auto summary = sent(orthanc, 0, 1);
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::Stored);
  EXPECT_EQ(summary.commitment, Commitment::NotSupported) << summary.commitment_note;
}

}  // namespace
}  // namespace arthronaut::pacs
