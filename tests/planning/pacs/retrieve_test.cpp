#include "planning/pacs/retrieve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "planning/files/atomic_file.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"
#include "tests/planning/pacs/sent_series.h"

namespace arthronaut::pacs {
namespace {

namespace fs = std::filesystem;
using Outcome = RetrieveSummary::Outcome;
using test::kImageCount;
using test::pixels_of;
using test::quick_connection;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class PacsRetrieve : public ::testing::Test {
 protected:
  // A folder of their own: what is beside the series is looked at.
  [[nodiscard]] RetrieveRequest request() const {
    return {
        .series_uid = test::DicomSeriesForm{}.origin.series_uid, .study_uid = "", .folder = got_ / "scan"};
  }
  [[nodiscard]] RetrieveSummary retrieve(const test::Orthanc& orthanc, const OnProgress& on_progress = {},
                                         const std::stop_token& stop = {}) const {
    return retrieve_series(orthanc.peer(), quick_connection(), request(), on_progress, stop);
  }
  void expect_whole() const {
    EXPECT_EQ(pixels_of(got_ / "scan"), pixels_of(made_ / "ct"));
    EXPECT_THAT(got_.names(), ElementsAre("scan"));
  }
  [[nodiscard]] std::string failure_of(const Peer& peer, const ConnectionOptions& connection,
                                       const RetrieveRequest& asked) const {
    try {
      (void)retrieve_series(peer, connection, asked);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  const test::TemporaryFolder made_, got_;
};

TEST_F(PacsRetrieve, FetchesEveryImageOnce) {
  const test::Orthanc orthanc;
  test::write_and_send(orthanc, made_ / "ct");
  std::vector<int> done;
  const auto summary = retrieve(orthanc, [&](const TransferProgress& progress) {
    EXPECT_EQ(progress.total, kImageCount);
    done.push_back(progress.done);
  });
  EXPECT_EQ(summary.outcome, Outcome::Whole);
  EXPECT_EQ(summary.way, "C-GET");
  EXPECT_EQ(summary.image_count, kImageCount);
  EXPECT_EQ(summary.kept_count, 0);
  EXPECT_EQ(summary.study_uid, test::DicomSeriesForm{}.origin.study_uid);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_EQ(done.back(), kImageCount);
  expect_whole();
  EXPECT_TRUE(files::is_private(got_ / "scan"));

  const auto again = retrieve(orthanc);
  EXPECT_EQ(again.outcome, Outcome::Whole);
  EXPECT_EQ(again.received_bytes, 0);
  EXPECT_EQ(again.kept_count, kImageCount);
  expect_whole();
}

// One image lost, one cut off, one with a hole at its end: these three come again, and no other.
TEST_F(PacsRetrieve, CompletesAFolder) {
  const test::Orthanc orthanc;
  test::write_and_send(orthanc, made_ / "ct");
  ASSERT_TRUE(retrieve(orthanc).is_usable());
  const std::string series = request().series_uid;
  fs::remove(got_ / "scan" / (series + ".7.dcm"));
  const fs::path cut = got_ / "scan" / (series + ".9.dcm"), empty = got_ / "scan" / (series + ".11.dcm");
  fs::resize_file(cut, fs::file_size(cut) - 1);
  fs::resize_file(empty, 0);
  const auto summary = retrieve(orthanc);
  EXPECT_EQ(summary.kept_count, kImageCount - 3);
  EXPECT_EQ(summary.image_count, kImageCount);
  expect_whole();
}

TEST_F(PacsRetrieve, LeavesAForeignFolderAlone) {
  const test::Orthanc orthanc;
  test::write_and_send(orthanc, made_ / "ct");
  fs::create_directory(got_ / "scan");
  files::write_atomically(got_ / "scan/letter.txt", "Dear colleague");
  EXPECT_THAT(failure_of(orthanc.peer(), quick_connection(), request()), HasSubstr("holds letter.txt"));
  EXPECT_THAT(got_.names(), ElementsAre("scan"));
  // An image of another series is foreign, too.
  RetrieveRequest other = request();
  other.series_uid += ".1";
  other.folder = made_ / "ct";
  EXPECT_THAT(failure_of(orthanc.peer(), quick_connection(), other), HasSubstr("no image of this series"));
}

TEST_F(PacsRetrieve, AnUnknownSeriesLeavesNothing) {
  const test::Orthanc orthanc;
  test::write_and_send(orthanc, made_ / "ct");
  RetrieveRequest unknown = request();
  unknown.series_uid = "1.2.3";
  const auto summary = retrieve_series(orthanc.peer(), quick_connection(), unknown);
  EXPECT_EQ(summary.outcome, Outcome::UnknownSeries);
  EXPECT_THAT(summary.message, HasSubstr("has no series 1.2.3"));
  EXPECT_THAT(got_.names(), ElementsAre());
  unknown.series_uid = "knee";
  EXPECT_THAT(failure_of(orthanc.peer(), quick_connection(), unknown), HasSubstr("no UID"));
  RetrieveRequest elsewhere = request();
  elsewhere.study_uid = "1.2.3";
  EXPECT_EQ(retrieve_series(orthanc.peer(), quick_connection(), elsewhere).outcome, Outcome::UnknownSeries);
}

TEST_F(PacsRetrieve, TakesNoMoreThanItMay) {
  const test::Orthanc orthanc;
  test::write_and_send(orthanc, made_ / "ct");
  RetrieveRequest small = request();
  small.most_bytes = static_cast<std::int64_t>(3 * fs::file_size(made_ / "ct/slice1000.dcm"));
  EXPECT_THAT(failure_of(orthanc.peer(), quick_connection(), small), HasSubstr("for the series"));
  EXPECT_FALSE(fs::exists(got_ / "scan"));
  RetrieveRequest modest = request();
  modest.least_free_bytes = std::numeric_limits<std::int64_t>::max();
  EXPECT_THAT(failure_of(orthanc.peer(), quick_connection(), modest), HasSubstr("are to stay"));
  // What came whole before stays for who allows more.
  const auto summary = retrieve(orthanc);
  EXPECT_GE(summary.kept_count, 1);
  expect_whole();
}

TEST_F(PacsRetrieve, WaitsInNobodyElsesFolder) {
  const test::Orthanc orthanc;
  test::write_and_send(orthanc, made_ / "ct");
  std::stop_source stop;
  const auto stop_soon = [&](const TransferProgress& progress) {
    if (progress.done == 3) stop.request_stop();
  };
  (void)retrieve(orthanc, stop_soon, stop.get_token());
  ASSERT_EQ(got_.names().size(), 1U);
  const fs::path waiting_room = got_ / got_.names().front();
  if (::geteuid() == 0) {
    constexpr uid_t kSomebody = 12345;
    ASSERT_EQ(::chown(waiting_room.c_str(), kSomebody, kSomebody), 0);
    EXPECT_THAT(failure_of(orthanc.peer(), quick_connection(), request()),
                HasSubstr("belongs to another user"));
  }
  fs::remove_all(waiting_room);
  const test::TemporaryFolder elsewhere;
  files::write_atomically(elsewhere / "letter.txt", "Dear colleague");
  fs::create_directory_symlink(elsewhere / ".", waiting_room);
  EXPECT_THAT(failure_of(orthanc.peer(), quick_connection(), request()), HasSubstr("is no folder"));
  EXPECT_THAT(elsewhere.names(), ElementsAre("letter.txt"));
}

TEST_F(PacsRetrieve, GoesOnWhereItWasStopped) {
  const test::Orthanc orthanc;
  test::write_and_send(orthanc, made_ / "ct");
  std::stop_source stop;
  constexpr int kStopAt = 17;
  const auto stopped = retrieve(
      orthanc,
      [&](const TransferProgress& progress) {
        if (progress.done == kStopAt) stop.request_stop();
      },
      stop.get_token());
  EXPECT_EQ(stopped.outcome, Outcome::Stopped);
  EXPECT_EQ(stopped.image_count, kStopAt);
  EXPECT_FALSE(fs::exists(got_ / "scan"));
  const auto resumed = retrieve(orthanc);
  EXPECT_EQ(resumed.outcome, Outcome::Whole);
  EXPECT_EQ(resumed.kept_count, kStopAt);
  expect_whole();
}

// As by a power cut, and up again when we try: the caller sees nothing of it.
TEST_F(PacsRetrieve, OutlivesAPeerThatIsKilledAndComesBack) {
  test::Orthanc orthanc;
  test::write_and_send(orthanc, made_ / "ct");
  bool was_killed = false;
  const auto summary = retrieve(orthanc, [&](const TransferProgress& progress) {
    if (progress.done != 10 || std::exchange(was_killed, true)) return;
    orthanc.kill();
    orthanc.start();
  });
  EXPECT_TRUE(was_killed);
  EXPECT_EQ(summary.outcome, Outcome::Whole);
  expect_whole();
}

TEST_F(PacsRetrieve, KeepsWhatCameWhenThePeerDies) {
  test::Orthanc orthanc;
  test::write_and_send(orthanc, made_ / "ct");
  const auto kill = [&](const TransferProgress& progress) {
    if (progress.done == 10) orthanc.kill();
  };
  EXPECT_THROW((void)retrieve(orthanc, kill), DeviceError);
  EXPECT_FALSE(fs::exists(got_ / "scan"));
  orthanc.start();
  const auto resumed = retrieve(orthanc);
  // What was on its way when it died has come, too.
  EXPECT_GE(resumed.kept_count, 10);
  EXPECT_LT(resumed.kept_count, kImageCount);
  expect_whole();
}

TEST_F(PacsRetrieve, IsSentTheSeriesWhereItMayNotGetIt) {
  const int our_port = test::free_port();
  const test::Orthanc orthanc({.allows_get = false, .our_port = our_port});
  test::write_and_send(orthanc, made_ / "ct");
  const auto refused = retrieve(orthanc);
  EXPECT_EQ(refused.outcome, Outcome::Incomplete);
  EXPECT_THAT(refused.message,
              testing::AllOf(HasSubstr("ended the connection"), HasSubstr("a port to listen at")));
  EXPECT_THAT(got_.names(), ElementsAre());
  ConnectionOptions listening = quick_connection();
  listening.listening_port = our_port;
  const auto summary = retrieve_series(orthanc.peer(), listening, request());
  EXPECT_EQ(summary.outcome, Outcome::Whole);
  EXPECT_EQ(summary.way, "C-MOVE");
  expect_whole();
  // What lacks is sent by itself, too.
  fs::remove(got_ / "scan" / (request().series_uid + ".7.dcm"));
  EXPECT_EQ(retrieve_series(orthanc.peer(), listening, request()).kept_count, kImageCount - 1);
  expect_whole();
}

TEST_F(PacsRetrieve, SaysThatThePeerDoesNotKnowWhereToSend) {
  const test::Orthanc orthanc({.knows_us = false});
  ConnectionOptions other = quick_connection();
  test::write_and_send(orthanc, made_ / "ct");
  other.listening_port = test::free_port();
  EXPECT_THAT(failure_of(orthanc.peer(), other, request()), HasSubstr("refused C-MOVE"));
  EXPECT_THAT(got_.names(), ElementsAre());
}

}  // namespace
}  // namespace arthronaut::pacs
