// A peer that is broken or means harm costs bounded memory, disk and time, and leaves nothing that was not
// asked for.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "planning/geometry/error.h"
#include "planning/pacs/query.h"
#include "planning/pacs/retrieve.h"
#include "planning/pacs/send.h"
#include "tests/planning/pacs/hostile_peer.h"
#include "tests/planning/pacs/sent_series.h"

namespace arthronaut::pacs {
namespace {

namespace fs = std::filesystem;
using test::answer_find;
using test::HostilePeer;
using test::quick_connection;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Request = HostilePeer::Request;

constexpr unsigned kPending = 0xFF00;
constexpr const char *kSeries = "1.2.3", *kStudy = "1.2", *kPatient = "4711";

template <typename Action>
std::string failure_of(const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(PacsHostile, AnswersThatDoNotEndAreCutOff) {
  std::atomic<int> sent = 0;
  const HostilePeer peer([&](Request& request) {
    if (request.message.CommandField != DIMSE_C_FIND_RQ) return true;  // does not heed C-CANCEL
    for (;;) {
      DcmDataset answer;
      const std::string uid = "1.2." + std::to_string(++sent);
      answer.putAndInsertString(DCM_StudyInstanceUID, uid.c_str());
      answer.putAndInsertString(DCM_PatientID, kPatient);
      if (!answer_find(request, &answer, kPending)) return false;
    }
  });
  const auto found = find(peer.peer(), quick_connection(), {.patient_id = kPatient},
                          {.level = FindLevel::Study, .most_studies = 20});
  EXPECT_TRUE(found.is_cut);
  ASSERT_EQ(found.patients.size(), 1U);
  EXPECT_EQ(found.patients[0].studies.size(), 20U);
}

TEST(PacsHostile, AnAnswerWithoutMeasureIsNotTakenIntoMemory) {
  const std::string endless(8 << 20, 'x');
  const HostilePeer peer([&](Request& request) {
    DcmDataset answer;
    answer.putAndInsertString(DCM_StudyInstanceUID, kStudy);
    answer.putAndInsertString(DCM_TextValue, endless.c_str());
    return answer_find(request, &answer, kPending) && answer_find(request, nullptr, STATUS_Success);
  });
  EXPECT_THAT(failure_of([&] { (void)find(peer.peer(), quick_connection(), {.patient_id = kPatient}); }),
              HasSubstr("cut off: it answers a search with more than 1 MB"));
}

// One byte of a long answer every 20 ms, for ever: each comes well within every time-out.
TEST(PacsHostile, APeerThatTricklesIsGivenUp) {
  const int port = test::free_port(), door = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  ASSERT_EQ(::bind(door, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  ASSERT_EQ(::listen(door, 1), 0);
  std::jthread trickler([&](const std::stop_token& stop) {
    const int caller = ::accept(door, nullptr, nullptr);
    // A-ASSOCIATE-AC of 512 kB.
    const unsigned char head[] = {2, 0, 0, 8, 0, 0};
    for (std::size_t i = 0; !stop.stop_requested(); ++i) {
      const unsigned char byte = i < sizeof(head) ? head[i] : 0;
      if (::send(caller, &byte, 1, MSG_NOSIGNAL) != 1) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ::close(caller);
  });
  ConnectionOptions impatient = quick_connection();
  impatient.connect_timeout_s = 1;
  impatient.retries = 0;
  EXPECT_THAT(failure_of([&] {
                (void)echo({"SLOW", "127.0.0.1", port}, impatient);
              }),
              HasSubstr("SLOW@127.0.0.1"));
  ::close(door);
}

// Lists one image, and sends what the test made of it.
class Liar {
 public:
  explicit Liar(std::function<void(DcmDataset&)> change, int copies = 1, bool changes_each = false)
      : change_(std::move(change)),
        copies_(copies),
        changes_each_(changes_each),
        peer_([this](Request& request) { return serve(request); }) {
    test::DicomSeriesForm form;
    form.patient.id = kPatient;
    form.origin.study_uid = kStudy;
    form.origin.series_uid = kSeries;
    test::write_dicom_series(made_ / "ct", test::ellipsoid_ct(), form);
  }
  [[nodiscard]] RetrieveSummary got(const fs::path& folder) const {
    return retrieve_series(peer_.peer(), quick_connection(), {.series_uid = kSeries, .folder = folder});
  }
  std::atomic<int> accepted = 0;
  std::atomic<int> said_count = 0;

 private:
  bool serve(Request& request) {
    if (request.message.CommandField == DIMSE_C_FIND_RQ) {
      DcmDataset answer;
      answer.putAndInsertString(DCM_PatientID, kPatient);
      answer.putAndInsertString(DCM_StudyInstanceUID, kStudy);
      answer.putAndInsertString(DCM_SeriesInstanceUID, kSeries);
      answer.putAndInsertString(DCM_SOPInstanceUID, "1.2.3.0");
      answer.putAndInsertString(DCM_SOPClassUID, UID_CTImageStorage);
      if (said_count > 0)
        answer.putAndInsertString(DCM_NumberOfSeriesRelatedInstances, std::to_string(said_count).c_str());
      return answer_find(request, &answer, kPending) && answer_find(request, nullptr, STATUS_Success);
    }
    if (request.message.CommandField != DIMSE_C_GET_RQ) return true;
    DcmFileFormat file;
    const auto any = fs::directory_iterator(made_ / "ct")->path();
    if (file.loadFile(any.c_str()).bad() || file.loadAllDataIntoMemory().bad()) return false;
    file.getDataset()->putAndInsertString(DCM_SOPInstanceUID, "1.2.3.0");
    change_(*file.getDataset());
    for (int i = 0; i < copies_; ++i) {
      if (i > 0 && changes_each_) change_(*file.getDataset());
      const unsigned status = test::store(request, *file.getDataset());
      if (status == 0xFFFF) return false;
      if (status == 0) ++accepted;
    }
    test::end_get(request, accepted == 0 ? 1 : 0);
    return true;
  }

  const test::TemporaryFolder made_;
  const std::function<void(DcmDataset&)> change_;
  const int copies_;
  const bool changes_each_;
  const HostilePeer peer_;
};

TEST(PacsHostile, WhatWasNotAskedForIsRefused) {
  struct Lie {
    DcmTagKey key;
    const char* value;
    const char* complaint;
  };
  for (const Lie& lie : {Lie{DCM_PatientID, "4712", "is of another patient"},
                         Lie{DCM_StudyInstanceUID, "1.3", "is of another study"},
                         Lie{DCM_SeriesInstanceUID, "1.2.4", "is of another series"},
                         Lie{DCM_SOPInstanceUID, "1.2.3.99", "was not asked for"}}) {
    const test::TemporaryFolder got;
    const Liar liar([&](DcmDataset& image) { image.putAndInsertString(lie.key, lie.value); });
    const auto summary = liar.got(got / "scan");
    EXPECT_EQ(summary.outcome, RetrieveSummary::Outcome::Incomplete) << lie.complaint;
    EXPECT_THAT(summary.message, HasSubstr(lie.complaint));
    EXPECT_EQ(liar.accepted, 0) << lie.complaint;
    EXPECT_THAT(got.names(), ElementsAre()) << lie.complaint;
  }
  // It is the lie that is refused.
  const test::TemporaryFolder got;
  const Liar honest([](DcmDataset&) {});
  EXPECT_TRUE(honest.got(got / "scan").is_usable());
}

TEST(PacsHostile, ASeriesOfMoreImagesThanItListsIsNotWhole) {
  const test::TemporaryFolder got;
  Liar short_list([](DcmDataset&) {});
  short_list.said_count = 4;
  const auto summary = short_list.got(got / "scan");
  EXPECT_EQ(summary.outcome, RetrieveSummary::Outcome::Incomplete);
  EXPECT_THAT(summary.message,
              HasSubstr("says that the series has 4 images, and lists 1: nothing was fetched"));
  EXPECT_EQ(short_list.accepted, 0);
  EXPECT_THAT(got.names(), ElementsAre());
  short_list.said_count = 1;
  EXPECT_TRUE(short_list.got(got / "scan").is_usable());
}

// Where it counts no images, what it sends beyond its list is told.
TEST(PacsHostile, WhatIsSentBeyondTheListIsToldOfAWholeSeries) {
  const test::TemporaryFolder got;
  int sent = 0;
  const Liar liar(
      [&](DcmDataset& image) {
        if (sent++ > 0) image.putAndInsertString(DCM_SOPInstanceUID, "1.2.3.99");
      },
      2, true);
  const auto summary = liar.got(got / "scan");
  EXPECT_EQ(summary.outcome, RetrieveSummary::Outcome::Whole);
  EXPECT_THAT(summary.message,
              HasSubstr("1 images that it sent were refused: image 1.2.3.99 was not asked for"));
}

TEST(PacsHostile, APeerThatGoesOnSendingItIsGivenUp) {
  const test::TemporaryFolder got;
  const Liar liar([](DcmDataset& image) { image.putAndInsertString(DCM_SOPInstanceUID, "1.2.3.99"); },
                  1000000);
  EXPECT_THAT(failure_of([&] { (void)liar.got(got / "scan"); }),
              HasSubstr("101 images that it sent were refused"));
  EXPECT_THAT(got.names(), ElementsAre());
}

TEST(PacsHostile, AReportWithoutMeasureIsNotTakenIntoMemory) {
  const std::string endless(8 << 20, 'x');
  const HostilePeer peer([&](Request& request) {
    if (request.message.CommandField == DIMSE_C_STORE_RQ) return test::take_file(request);
    if (request.message.CommandField != DIMSE_N_ACTION_RQ) return true;
    T_DIMSE_Message answer{};
    answer.CommandField = DIMSE_N_ACTION_RSP;
    answer.msg.NActionRSP.MessageIDBeingRespondedTo = request.message.msg.NActionRQ.MessageID;
    answer.msg.NActionRSP.DataSetType = DIMSE_DATASET_NULL;
    if (DIMSE_sendMessageUsingMemoryData(&request.association, request.context, &answer, nullptr, nullptr,
                                         nullptr, nullptr)
            .bad())
      return false;
    OFString transaction;
    request.data.findAndGetOFString(DCM_TransactionUID, transaction);
    DcmDataset data;
    data.putAndInsertString(DCM_TransactionUID, transaction.c_str());
    data.putAndInsertString(DCM_TextValue, endless.c_str());
    return test::report_commitment(request, data);
  });
  const test::TemporaryFolder folder;
  test::write_dicom_series(folder / "ct", test::ellipsoid_ct());
  const auto summary = send_files(peer.peer(), quick_connection(), files_to_send({folder / "ct"}));
  EXPECT_EQ(summary.outcome, SendSummary::Outcome::Stored);
  EXPECT_EQ(summary.commitment, Commitment::Awaited);
  EXPECT_THAT(summary.commitment_note, HasSubstr("its report of storage commitment is larger than"));
}

}  // namespace
}  // namespace arthronaut::pacs
