#include "planning/pacs/retrieve.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmnet/diutil.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <set>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/pacs/association.h"
#include "planning/pacs/checks.h"
#include "planning/pacs/finding.h"
#include "planning/pacs/incoming_series.h"
#include "planning/pacs/listener.h"
#include "planning/pacs/series_images.h"
#include "planning/pacs/storing.h"

namespace arthronaut::pacs {

namespace {

// A request names at most so many images: some peers bound the length of a list.
constexpr std::size_t kMostImagesAtOnce = 200;
// A peer that fetches from tape says that it is at work; after so many time-outs without an image it is not.
constexpr int kTimeoutsWithoutImage = 10;

// Hostile: the next attempt would end in the same way.
enum class End { Answered, Broken, Refused, Hostile };

struct Attempt {
  End end = End::Broken;
  std::string reason;
};

// As the peer keeps them: it picks the context of what it has, and need not decode. Every class with the
// uncompressed syntaxes; as many of them as there is room for with each compressed one.
std::vector<Proposal> get_proposals(const std::set<std::string>& classes) {
  std::vector<Proposal> proposals;
  for (const char* model :
       {UID_GETStudyRootQueryRetrieveInformationModel, UID_GETPatientRootQueryRetrieveInformationModel})
    proposals.push_back({.sop_class = model, .transfer_syntaxes = uncompressed_syntaxes()});
  std::vector<std::string> wanted(classes.begin(), classes.end());
  if (wanted.empty())
    for (int i = 0; i < numberOfDcmLongSCUStorageSOPClassUIDs; ++i)
      wanted.emplace_back(dcmLongSCUStorageSOPClassUIDs[i]);
  wanted.resize(std::min(wanted.size(), kMostProposals - proposals.size()));
  for (const std::string& sop_class : wanted) proposals.push_back({sop_class, uncompressed_syntaxes(), true});
  for (const std::string& sop_class : wanted)
    for (const std::string& syntax : compressed_syntaxes())
      if (proposals.size() < kMostProposals) proposals.push_back({sop_class, {syntax}, true});
  return proposals;
}

// Ends a C-MOVE whose peer answers on and on and sends nothing.
class MoveWatch {
 public:
  void begin(Association& association) {
    association_ = &association;
    note_image();
  }
  // On a thread of the listener's.
  void note_image() { last_image_ = std::chrono::steady_clock::now(); }
  static void on_answer(void* data, T_DIMSE_C_MoveRQ* /*request*/, int /*count*/,
                        T_DIMSE_C_MoveRSP* /*response*/) {
    const auto& watch = *static_cast<MoveWatch*>(data);
    Line& line = watch.association_->line();
    line.allowance.allow(kLargestRemark_bytes, "it answers with more than 16 MB");
    const auto patience =
        std::chrono::seconds(kTimeoutsWithoutImage * watch.association_->answer_timeout_s());
    if (std::chrono::steady_clock::now() - watch.last_image_.load() < patience) return;
    line.allowance.complain("it says that it is at work, and sends nothing", false);
    line.socket.cut();
  }

 private:
  Association* association_ = nullptr;
  std::atomic<std::chrono::steady_clock::time_point> last_image_ = std::chrono::steady_clock::now();
};

class Retrieval {
 public:
  Retrieval(const Peer& peer, const ConnectionOptions& connection, const RetrieveRequest& request,
            const OnProgress& on_progress, const std::stop_token& stop)
      : peer_(peer),
        connection_(connection),
        request_(request),
        on_progress_(on_progress),
        stop_(stop),
        series_(request.folder, request.series_uid,
                {request.most_bytes, request.least_free_bytes, request.free_bytes}) {}

  RetrieveSummary run() {
    RetrieveSummary summary;
    summary.kept_count = series_.count();
    try {
      summary.outcome = fetch(summary);
    } catch (...) {
      series_.leave();
      throw;
    }
    summary.study_uid = images_.study_uid;
    summary.image_count = series_.count();
    summary.received_bytes = series_.received_bytes();
    if (summary.outcome == RetrieveSummary::Outcome::Whole) {
      series_.finish();
      summary.message =
          files::format("%d images of the series are in ", summary.image_count) + request_.folder.string();
      if (const std::string refusal = series_.refusal(); !refusal.empty()) summary.message += "; " + refusal;
    } else {
      series_.leave();
    }
    if (summary.outcome == RetrieveSummary::Outcome::Stopped) summary.message = "stopped; " + waiting_words();
    return summary;
  }

 private:
  using Outcome = RetrieveSummary::Outcome;

  Outcome fetch(RetrieveSummary& summary) {
    images_ = ask_series_images(peer_, connection_, request_.series_uid, request_.study_uid, stop_);
    if (images_.was_stopped) return Outcome::Stopped;
    if (!images_.is_known) {
      summary.message =
          to_text(peer_) + ": has no series " + request_.series_uid +
          (request_.study_uid.empty() ? "; if it should, name its study too" : " in that study");
      return Outcome::UnknownSeries;
    }
    if (images_.is_cut_off()) {
      summary.message = to_text(peer_) + ": " + images_.cut_off_words();
      return Outcome::Incomplete;
    }
    series_.expect({.study_uid = images_.study_uid,
                    .patient_id = images_.patient_id,
                    .class_by_uid = images_.class_by_uid});
    if (!is_whole()) (void)series_.room();  // throws when there is none
    report_progress();
    bool by_move = false;
    for (int fruitless = 0; !is_whole();) {
      const int before = series_.count();
      summary.way = by_move ? "C-MOVE" : "C-GET";
      const Attempt attempt = by_move ? move() : get();
      if (stop_.stop_requested()) return Outcome::Stopped;
      if (is_whole()) break;
      if (attempt.end == End::Refused && !by_move && connection_.listening_port > 0) {
        by_move = true;
        continue;
      }
      if (attempt.end == End::Hostile) throw DeviceError(to_text(peer_) + ": " + attempt.reason);
      if (attempt.end == End::Refused)
        throw DeviceError(to_text(peer_) + ": " + attempt.reason + refusal_hint(by_move));
      fruitless = series_.count() > before ? 0 : fruitless + 1;
      // Orthanc, for one, refuses C-GET by ending the connection. Where that was no refusal, C-MOVE does as
      // well.
      if (attempt.end == End::Broken && fruitless > 0 && !by_move && connection_.listening_port > 0) {
        by_move = true;
        continue;
      }
      // A peer that answered, and brought nothing new, would do so again.
      const bool is_hopeless = attempt.end == End::Answered && fruitless > 0;
      if (is_hopeless || fruitless > connection_.retries) {
        const std::string refusal = series_.refusal();
        summary.message = to_text(peer_) + ": " + attempt.reason + (refusal.empty() ? "" : "; " + refusal) +
                          "; " + waiting_words() + (series_.count() == 0 ? refusal_hint(by_move) : "");
        return Outcome::Incomplete;
      }
      if (attempt.end == End::Broken) pause_before_retry(connection_, fruitless, attempt.reason, stop_);
    }
    return Outcome::Whole;
  }

  [[nodiscard]] std::string refusal_hint(bool by_move) const {
    if (by_move || connection_.listening_port > 0) return "";
    return "; to be sent it by C-MOVE instead, give a port to listen at, which the peer knows as " +
           connection_.our_ae_title + "'s";
  }

  [[nodiscard]] std::string waiting_words() const {
    if (series_.count() == 0) return "nothing was kept";
    return files::format("%d of %d images are kept, and the same again goes on from there", series_.count(),
                         total());
  }

  [[nodiscard]] int total() const {
    return std::max(static_cast<int>(images_.class_by_uid.size()), images_.said_count);
  }

  [[nodiscard]] std::vector<std::string> missing() const {
    std::vector<std::string> uids;
    for (const auto& [uid, sop_class] : images_.class_by_uid)
      if (!series_.has(uid)) uids.push_back(uid);
    return uids;
  }

  // A peer that lists no images is believed when it says that it has sent all, unless it counts more.
  [[nodiscard]] bool is_whole() const {
    if (!images_.class_by_uid.empty()) return missing().empty();
    return has_sent_all_ && series_.count() > 0 && series_.count() >= images_.said_count;
  }

  void report_progress() const {
    if (on_progress_)
      on_progress_({.done = series_.count(), .total = total(), .bytes = series_.received_bytes()});
  }

  // The whole series, or the images that lack.
  void put_identifiers(DcmDataset& query) const {
    std::vector<std::string> lacking = missing();
    const bool is_all = lacking.size() == images_.class_by_uid.size();
    put_key(query, DCM_QueryRetrieveLevel, is_all ? "SERIES" : "IMAGE");
    if (!images_.patient_id.empty()) put_key(query, DCM_PatientID, images_.patient_id);
    if (!images_.study_uid.empty()) put_key(query, DCM_StudyInstanceUID, images_.study_uid);
    put_key(query, DCM_SeriesInstanceUID, request_.series_uid);
    if (is_all) return;
    lacking.resize(std::min(lacking.size(), kMostImagesAtOnce));
    std::string list;
    for (const std::string& uid : lacking) list += (list.empty() ? "" : "\\") + uid;
    put_key(query, DCM_SOPInstanceUID, list);
  }

  // The final answer of either operation in words; the peer's status with how many it could not send.
  Attempt ended(const char* operation, unsigned status, const std::string& comment, int failed) {
    if (status == STATUS_Success) {
      has_sent_all_ = failed == 0;
      return {End::Answered, "says that it has sent all, and has not"};
    }
    const bool is_partial = (status & 0xF000U) == 0xB000 || failed > 0;
    if (is_partial) return {End::Answered, files::format("could not send %d images", failed)};
    return {End::Refused, std::string("refused ") + operation + " with " + status_text(status, comment)};
  }

  // Empty where the peer leaves one open.
  [[nodiscard]] std::set<std::string> sop_classes() const {
    std::set<std::string> classes;
    for (const auto& [uid, sop_class] : images_.class_by_uid) {
      if (!is_uid(sop_class)) return {};
      classes.insert(sop_class);
    }
    return classes;
  }

  // What an attempt ended with, whatever DCMTK calls it.
  [[nodiscard]] Attempt broken(Association& association, const OFCondition& outcome) const {
    if (series_.is_fed_up()) return {End::Hostile, series_.refusal()};
    return {association.is_given_up_for_good() ? End::Hostile : End::Broken, association.why(outcome)};
  }

  Attempt get() {
    const auto association = Association::connect(peer_, connection_, get_proposals(sop_classes()), stop_);
    if (!association) return {};
    const char* model = UID_GETStudyRootQueryRetrieveInformationModel;
    if (association->accepted(model) == 0) model = UID_GETPatientRootQueryRetrieveInformationModel;
    const T_ASC_PresentationContextID context = association->accepted(model);
    if (context == 0) return {End::Refused, "does not offer C-GET to us"};
    T_DIMSE_Message message{};
    message.CommandField = DIMSE_C_GET_RQ;
    T_DIMSE_C_GetRQ& request = message.msg.CGetRQ;
    request.MessageID = association->next_message_id();
    OFStandard::strlcpy(request.AffectedSOPClassUID, model, DIC_UI_LEN + 1);
    request.Priority = DIMSE_PRIORITY_MEDIUM;
    request.DataSetType = DIMSE_DATASET_PRESENT;
    DcmDataset query;
    put_identifiers(query);
    const OFCondition outcome = DIMSE_sendMessageUsingMemoryData(&association->get(), context, &message,
                                                                 nullptr, &query, nullptr, nullptr);
    if (outcome.bad()) return broken(*association, outcome);
    const Attempt attempt = receive(*association);
    if (attempt.end == End::Answered || attempt.end == End::Refused) association->release();
    return attempt;
  }

  // Images and answers, until the last one.
  Attempt receive(Association& association) {
    const int timeout_s = association.answer_timeout_s();
    const auto patience = std::chrono::seconds(kTimeoutsWithoutImage * timeout_s);
    auto last_image = std::chrono::steady_clock::now();
    for (;;) {
      association.expect_command();
      T_DIMSE_Message message{};
      T_ASC_PresentationContextID context = 0;
      DcmDataset* detail = nullptr;
      OFCondition outcome =
          DIMSE_receiveCommand(&association.get(), DIMSE_NONBLOCKING, timeout_s, &context, &message, &detail);
      const std::string comment = take_comment(detail);
      if (outcome.bad()) return broken(association, outcome);
      if (message.CommandField == DIMSE_C_STORE_RQ) {
        outcome = receive_image(association.get(), association.line(), context, message.msg.CStoreRQ,
                                timeout_s, series_);
        if (outcome.bad()) return broken(association, outcome);
        report_progress();
        last_image = std::chrono::steady_clock::now();
        continue;
      }
      if (message.CommandField != DIMSE_C_GET_RSP)
        return {End::Broken, "the peer sent what was not asked for"};
      const T_DIMSE_C_GetRSP& response = message.msg.CGetRSP;
      if (response.DataSetType == DIMSE_DATASET_PRESENT) {
        association.line().allowance.allow(kLargestRemark_bytes, "it answers with more than 16 MB");
        DIC_UL bytes = 0, parts = 0;  // the list of what failed
        outcome = DIMSE_ignoreDataSet(&association.get(), DIMSE_NONBLOCKING, timeout_s, &bytes, &parts);
        if (outcome.bad()) return broken(association, outcome);
      }
      if (DICOM_PENDING_STATUS(response.DimseStatus)) {
        if (std::chrono::steady_clock::now() - last_image < patience) continue;
        return {End::Broken, "says that it is at work, and sends nothing"};
      }
      const bool tells_failed = (response.opts & O_GET_NUMBEROFFAILEDSUBOPERATIONS) != 0;
      return ended("C-GET", response.DimseStatus, comment,
                   tells_failed ? response.NumberOfFailedSubOperations : 0);
    }
  }

  Attempt move() {
    MoveWatch watch;
    Listener listener(connection_, {.series = &series_,
                                    .sop_classes = sop_classes(),
                                    .on_image =
                                        [this, &watch] {
                                          watch.note_image();
                                          report_progress();
                                        },
                                    .largest_report_bytes = 0,
                                    .on_commitment = {}});
    std::vector<Proposal> proposals;
    for (const char* model :
         {UID_MOVEStudyRootQueryRetrieveInformationModel, UID_MOVEPatientRootQueryRetrieveInformationModel})
      proposals.push_back({.sop_class = model, .transfer_syntaxes = uncompressed_syntaxes()});
    const auto association = Association::connect(peer_, connection_, proposals, stop_);
    if (!association) return {};
    const char* model = proposals[0].sop_class.c_str();
    if (association->accepted(model) == 0) model = proposals[1].sop_class.c_str();
    const T_ASC_PresentationContextID context = association->accepted(model);
    if (context == 0) return {End::Refused, "offers neither C-GET nor C-MOVE to us"};
    T_DIMSE_C_MoveRQ request{};
    request.MessageID = association->next_message_id();
    OFStandard::strlcpy(request.AffectedSOPClassUID, model, DIC_UI_LEN + 1);
    OFStandard::strlcpy(request.MoveDestination, connection_.our_ae_title.c_str(), DIC_AE_LEN + 1);
    request.Priority = DIMSE_PRIORITY_MEDIUM;
    request.DataSetType = DIMSE_DATASET_PRESENT;
    DcmDataset query;
    put_identifiers(query);
    T_DIMSE_C_MoveRSP response{};
    DcmDataset *detail = nullptr, *failed = nullptr;
    association->line().allowance.allow(kLargestRemark_bytes, "it answers with more than 16 MB");
    watch.begin(*association);
    const OFCondition outcome = DIMSE_moveUser(
        &association->get(), context, &request, &query, &MoveWatch::on_answer, &watch, DIMSE_NONBLOCKING,
        association->answer_timeout_s(), nullptr, nullptr, nullptr, &response, &detail, &failed);
    const std::string comment = take_comment(detail);
    delete failed;
    if (const std::string failure = listener.failure(); !failure.empty()) throw IoError(failure);
    if (series_.is_fed_up()) return {End::Hostile, series_.refusal()};
    if (const std::string complaint = listener.complaint(); !complaint.empty())
      return {End::Broken, "was cut off: " + complaint};
    if (outcome.bad()) return broken(*association, outcome);
    association->release();
    const bool tells_failed = (response.opts & O_MOVE_NUMBEROFFAILEDSUBOPERATIONS) != 0;
    return ended("C-MOVE", response.DimseStatus, comment,
                 tells_failed ? response.NumberOfFailedSubOperations : 0);
  }

  const Peer& peer_;
  const ConnectionOptions& connection_;
  const RetrieveRequest& request_;
  const OnProgress& on_progress_;
  const std::stop_token& stop_;
  IncomingSeries series_;
  SeriesImages images_;
  bool has_sent_all_ = false;
};

}  // namespace

void check(const RetrieveRequest& request) {
  if (!is_uid(request.series_uid))
    throw InvalidInput("series \"" + request.series_uid + "\": no UID; it has digits and dots, at most 64");
  if (!request.study_uid.empty() && !is_uid(request.study_uid))
    throw InvalidInput("study \"" + request.study_uid + "\": no UID; it has digits and dots, at most 64");
  if (request.most_bytes < 1) throw InvalidInput("most_bytes: must be at least 1");
  if (request.least_free_bytes < 0) throw InvalidInput("least_free_bytes: must not be negative");
}

RetrieveSummary retrieve_series(const Peer& peer, const ConnectionOptions& connection,
                                const RetrieveRequest& request, const OnProgress& on_progress,
                                const std::stop_token& stop) {
  check(connection);
  check(request);
  return Retrieval(peer, connection, request, on_progress, stop).run();
}

}  // namespace arthronaut::pacs
