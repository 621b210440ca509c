#include "planning/pacs/commitment.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmnet/diutil.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <set>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"
#include "planning/pacs/association.h"
#include "planning/pacs/listener.h"

namespace arthronaut::pacs {

namespace {

constexpr int kRequestCommitment = 1;
constexpr int kPoll_s = 1;

struct Report {
  std::set<std::string> kept;                 // SOP instances that the peer names as kept
  std::map<std::string, std::string> failed;  // reason by SOP instance
};

// Twice what a reference and its failure take, and the frame around them.
constexpr std::int64_t kReportBytesPerFile = 1024, kReportFrame_bytes = 64 * 1024;

// What arrives on any connection; of another transaction is none of ours, nor what we did not send. One
// report is kept, the last.
class Reports {
 public:
  Reports(std::string transaction_uid, std::set<std::string> sent)
      : transaction_uid_(std::move(transaction_uid)), sent_(std::move(sent)) {}
  [[nodiscard]] std::int64_t largest_bytes() const {
    return kReportFrame_bytes + kReportBytesPerFile * static_cast<std::int64_t>(sent_.size());
  }
  void take(DcmDataset& data) {
    if (images::text_of(data, DCM_TransactionUID) != transaction_uid_) return;
    Report report;
    DcmItem* item = nullptr;
    for (long i = 0; data.findAndGetSequenceItem(DCM_ReferencedSOPSequence, item, i).good(); ++i)
      if (const auto uid = images::text_of(*item, DCM_ReferencedSOPInstanceUID); sent_.contains(uid))
        report.kept.insert(uid);
    for (long i = 0; data.findAndGetSequenceItem(DCM_FailedSOPSequence, item, i).good(); ++i) {
      const std::string uid = images::text_of(*item, DCM_ReferencedSOPInstanceUID);
      if (!sent_.contains(uid)) continue;
      const int reason = images::unsigned_short_of(*item, DCM_FailureReason, 0);
      report.failed[uid] = status_text(static_cast<unsigned>(reason), "");
    }
    const std::scoped_lock lock(mutex_);
    report_ = std::move(report);
  }
  [[nodiscard]] std::optional<Report> report() const {
    const std::scoped_lock lock(mutex_);
    return report_;
  }

 private:
  const std::string transaction_uid_;
  const std::set<std::string> sent_;
  mutable std::mutex mutex_;
  std::optional<Report> report_;
};

std::string new_uid() {
  char uid[DIC_UI_LEN + 1] = {};
  return dcmGenerateUniqueIdentifier(uid);
}

void put_references(DcmDataset& action, const std::string& transaction_uid, const SendSummary& summary) {
  action.putAndInsertString(DCM_TransactionUID, transaction_uid.c_str());
  long number = 0;
  for (const SentFile& file : summary.files) {
    DcmItem* item = nullptr;
    if (!file.is_stored || action.findOrCreateSequenceItem(DCM_ReferencedSOPSequence, item, number++).bad())
      continue;
    item->putAndInsertString(DCM_ReferencedSOPClassUID, file.sop_class_uid.c_str());
    item->putAndInsertString(DCM_ReferencedSOPInstanceUID, file.sop_instance_uid.c_str());
  }
}

struct ActionAnswer {
  bool is_broken = false;
  unsigned status = 0;
  std::string note;
};

// Reads what comes until the answer to the action, or until a report when `waits_for_report`.
ActionAnswer read_until(Association& association, Reports& reports, bool waits_for_report,
                        std::chrono::steady_clock::time_point until, const std::stop_token& stop) {
  // The peer may report before it answers; not without end.
  constexpr int kMostMessages = 1000;
  for (int i = 0; !stop.stop_requested();) {
    if (waits_for_report && (reports.report() || std::chrono::steady_clock::now() >= until)) return {};
    if (waits_for_report && !ASC_dataWaiting(&association.get(), kPoll_s)) continue;
    if (++i > kMostMessages) return {.is_broken = true, .status = 0, .note = "it reports without end"};
    T_DIMSE_Message message{};
    T_ASC_PresentationContextID context = 0;
    DcmDataset* detail = nullptr;
    association.expect_command();
    OFCondition outcome = DIMSE_receiveCommand(&association.get(), DIMSE_NONBLOCKING,
                                               association.answer_timeout_s(), &context, &message, &detail);
    const std::string comment = take_comment(detail);
    if (outcome.good() && message.CommandField == DIMSE_N_EVENT_REPORT_RQ) {
      outcome = receive_commitment_report(association.get(), association.line(), reports.largest_bytes(),
                                          context, message.msg.NEventReportRQ, association.answer_timeout_s(),
                                          [&](int, DcmDataset& data) { reports.take(data); });
      if (outcome.good()) continue;
    }
    if (outcome.bad()) return {.is_broken = true, .status = 0, .note = association.why(outcome)};
    if (message.CommandField != DIMSE_N_ACTION_RSP)
      return {.is_broken = true, .status = 0, .note = "the peer sent what was not asked for"};
    const T_DIMSE_N_ActionRSP& response = message.msg.NActionRSP;
    if (response.DataSetType == DIMSE_DATASET_PRESENT) {
      association.line().allowance.allow(kLargestRemark_bytes, "it answers with more than 16 MB");
      DIC_UL bytes = 0, parts = 0;
      (void)DIMSE_ignoreDataSet(&association.get(), DIMSE_NONBLOCKING, association.answer_timeout_s(), &bytes,
                                &parts);
    }
    return {.is_broken = false,
            .status = response.DimseStatus,
            .note = status_text(response.DimseStatus, comment)};
  }
  return {.is_broken = true, .status = 0, .note = "stopped"};
}

OFCondition send_action(Association& association, T_ASC_PresentationContextID context, DcmDataset& action) {
  T_DIMSE_Message message{};
  message.CommandField = DIMSE_N_ACTION_RQ;
  T_DIMSE_N_ActionRQ& request = message.msg.NActionRQ;
  request.MessageID = association.next_message_id();
  OFStandard::strlcpy(request.RequestedSOPClassUID, UID_StorageCommitmentPushModelSOPClass, DIC_UI_LEN + 1);
  OFStandard::strlcpy(request.RequestedSOPInstanceUID, UID_StorageCommitmentPushModelSOPInstance,
                      DIC_UI_LEN + 1);
  request.ActionTypeID = kRequestCommitment;
  request.DataSetType = DIMSE_DATASET_PRESENT;
  return DIMSE_sendMessageUsingMemoryData(&association.get(), context, &message, nullptr, &action, nullptr,
                                          nullptr);
}

void take_report(const Report& report, SendSummary& summary) {
  int failed = 0;
  for (SentFile& file : summary.files) {
    if (!file.is_stored) continue;
    const auto found = report.failed.find(file.sop_instance_uid);
    // Kept is what the peer says that it keeps: of what it is silent about nobody knows.
    file.is_committed = found == report.failed.end() && report.kept.contains(file.sop_instance_uid);
    if (file.is_committed) continue;
    ++failed;
    file.note = "stored, but the peer does not commit itself to keep it: " +
                (found != report.failed.end() ? found->second : "its report does not name it");
  }
  summary.commitment = failed == 0 ? Commitment::Confirmed : Commitment::Failed;
  summary.commitment_note = failed == 0 ? "the peer keeps all that it was sent"
                                        : files::format("the peer does not keep %d of the files", failed);
}

}  // namespace

void ask_commitment(const Peer& peer, const ConnectionOptions& connection, const SendOptions& options,
                    SendSummary& summary, const std::stop_token& stop) {
  const std::string transaction_uid = new_uid();
  std::set<std::string> sent;
  for (const SentFile& file : summary.files)
    if (file.is_stored) sent.insert(file.sop_instance_uid);
  Reports reports(transaction_uid, std::move(sent));
  std::optional<Listener> listener;
  if (connection.listening_port > 0)
    listener.emplace(connection,
                     Listener::Handlers{.series = nullptr,
                                        .on_image = {},
                                        .largest_report_bytes = reports.largest_bytes(),
                                        .on_commitment = [&](int, DcmDataset& data) { reports.take(data); }});
  const auto association = Association::connect(
      peer, connection,
      {{.sop_class = UID_StorageCommitmentPushModelSOPClass, .transfer_syntaxes = uncompressed_syntaxes()}},
      stop);
  summary.commitment = Commitment::NotSupported;
  summary.commitment_note = "the peer does not offer storage commitment to us";
  if (!association) return;
  const T_ASC_PresentationContextID context = association->accepted(UID_StorageCommitmentPushModelSOPClass);
  if (context == 0) return association->release();
  DcmDataset action;
  put_references(action, transaction_uid, summary);
  const OFCondition outcome = send_action(*association, context, action);
  const auto never = std::chrono::steady_clock::time_point::max();
  const ActionAnswer answer =
      outcome.good() ? read_until(*association, reports, false, never, stop)
                     : ActionAnswer{.is_broken = true, .status = 0, .note = association->why(outcome)};
  // What it has said of the files counts, whatever became of its answer to the request.
  if (!answer.is_broken && answer.status != STATUS_Success && !reports.report()) {
    summary.commitment_note = "the peer refused to commit itself to storage: " + answer.note;
    return;
  }
  const auto until = std::chrono::steady_clock::now() +
                     std::chrono::milliseconds(static_cast<long>(1000 * options.commitment_wait_s));
  if (!answer.is_broken) {
    const ActionAnswer end = read_until(*association, reports, true, until, stop);
    if (end.note.empty()) association->release();
  }
  // The peer may have ended this connection and be calling on its own: about what has reached it.
  while (outcome.good() && listener && !reports.report() && !stop.stop_requested() &&
         std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (const auto report = reports.report()) return take_report(*report, summary);
  summary.commitment = Commitment::Awaited;
  summary.commitment_note =
      answer.is_broken
          ? "whether the peer keeps the files is not known, its answer to the request was lost (some peers "
            "end the connection of whom they do not know): " +
                answer.note
          : files::format("the peer will say whether it keeps the files, and has not within %g s",
                          options.commitment_wait_s);
  std::string complaint = association->line().allowance.complaint();
  if (listener && complaint.empty()) complaint = listener->complaint();
  if (!complaint.empty()) summary.commitment_note += "; a connection was cut off: " + complaint;
  if (!listener && !answer.is_broken)
    summary.commitment_note += "; it may want to call back: give a port to listen at";
}

}  // namespace arthronaut::pacs
