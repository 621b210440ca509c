#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/pacs/send.h"
#include "tests/planning/pacs/hostile_peer.h"
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

// Orthanc commits itself to those alone whom it knows, and ends the connection of others without a word:
// which a line that breaks does, too.
TEST(PacsCommitment, IsNotKnownWhereThePeerEndsTheConnection) {
  const test::Orthanc orthanc({.knows_us = false});
  const auto summary = sent(orthanc, 0, 1);
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::Stored);
  EXPECT_EQ(summary.commitment, Commitment::Awaited) << summary.commitment_note;
  EXPECT_THAT(summary.commitment_note, HasSubstr("end the connection of whom they do not know"));
}

using test::HostilePeer;

// Stores what it is sent, and breaks the connection off at the request, having reported before or not.
bool break_off_at_the_request(HostilePeer::Request& request, bool reports_before) {
  if (request.message.CommandField == DIMSE_C_STORE_RQ) return test::take_file(request);
  if (request.message.CommandField != DIMSE_N_ACTION_RQ) return true;
  if (!reports_before) return false;
  (void)test::report_commitment(request, request.data);  // the request names what the report names
  T_DIMSE_Message answer{};
  T_ASC_PresentationContextID context = 0;
  DcmDataset* detail = nullptr;
  (void)DIMSE_receiveCommand(&request.association, DIMSE_NONBLOCKING, 10, &context, &answer, &detail);
  delete detail;
  return false;
}

SendSummary sent_to_one_that_breaks_off(bool reports_before) {
  const HostilePeer peer(
      [=](HostilePeer::Request& request) { return break_off_at_the_request(request, reports_before); });
  const test::TemporaryFolder folder;
  test::write_dicom_series(folder / "ct", test::ellipsoid_ct());
  return send_files(peer.peer(), quick_connection(), files_to_send({folder / "ct"}),
                    {.commitment_wait_s = 1});
}

// Its answer to the request is lost, but it has said what it keeps.
TEST(PacsCommitment, AReportBeforeTheConnectionBreaksCounts) {
  const auto summary = sent_to_one_that_breaks_off(true);
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::Stored);
  EXPECT_EQ(summary.commitment, Commitment::Confirmed) << summary.commitment_note;
  for (const SentFile& file : summary.files) EXPECT_TRUE(file.is_committed) << file.file;
}

TEST(PacsCommitment, AConnectionThatBreaksIsNoRefusal) {
  const auto summary = sent_to_one_that_breaks_off(false);
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::Stored);
  EXPECT_EQ(summary.commitment, Commitment::Awaited) << summary.commitment_note;
  EXPECT_THAT(summary.commitment_note, HasSubstr("its answer to the request was lost"));
}

}  // namespace
}  // namespace arthronaut::pacs
