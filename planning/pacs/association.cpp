#include "planning/pacs/association.h"

#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmnet/dcmtrans.h>
#include <dcmtk/dcmnet/diutil.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/pacs/dcmtk_log.h"

namespace arthronaut::pacs {

namespace {

// Larger ones are not had with every peer; DCMTK takes no larger.
constexpr long kLargestPdu_bytes = ASC_MAXIMUMPDUSIZE;

constexpr double kLongestPause_s = 15;
constexpr const char* kBroke = "the connection broke";
constexpr std::chrono::milliseconds kLongestFarewell{500};
// For a host of several addresses, TLS and the negotiation together.
constexpr double kConnectTimeouts = 3;

int whole_seconds(double seconds) { return static_cast<int>(std::ceil(seconds)); }

void prepare_network(const ConnectionOptions& options) {
  static std::once_flag once;
  std::call_once(once, [] {
    OFStandard::initializeNetwork();
    silence_dcmtk();
    // A name is looked up once, to connect; never that of who connects to us.
    dcmDisableGethostbyaddr.set(OFTrue);
  });
  // DCMTK has one of each for the whole program.
  dcmConnectionTimeout.set(whole_seconds(options.connect_timeout_s));
  dcmSocketSendTimeout.set(whole_seconds(options.answer_timeout_s));
  dcmSocketReceiveTimeout.set(whole_seconds(options.answer_timeout_s));
}

struct Refusal {
  std::string reason;
  bool is_for_good = false;
};

Refusal refusal_of(const T_ASC_RejectParameters& reject, const Peer& peer, const ConnectionOptions& options) {
  Refusal refusal{.reason = "refused the association", .is_for_good = true};
  switch (reject.reason) {
    case ASC_REASON_SU_CALLEDAETITLENOTRECOGNIZED:
      refusal.reason += ": it does not answer to the AE title " + peer.ae_title;
      break;
    case ASC_REASON_SU_CALLINGAETITLENOTRECOGNIZED:
      refusal.reason += ": it does not know us as " + options.our_ae_title;
      break;
    case ASC_REASON_SP_PRES_TEMPORARYCONGESTION:
    case ASC_REASON_SP_PRES_LOCALLIMITEXCEEDED:
      refusal.reason += ": it has too many connections now";
      break;
    case ASC_REASON_SU_APPCONTEXTNAMENOTSUPPORTED:
    case ASC_REASON_SP_ACSE_PROTOCOLVERSIONNOTSUPPORTED:
      refusal.reason += ": it speaks another version of DICOM";
      break;
    default:
      refusal.reason += " and gave no reason";
      break;
  }
  refusal.is_for_good = reject.result != ASC_RESULT_REJECTEDTRANSIENT;
  return refusal;
}

}  // namespace

const std::vector<std::string>& uncompressed_syntaxes() {
  static const std::vector<std::string> syntaxes{UID_LittleEndianExplicitTransferSyntax,
                                                 UID_LittleEndianImplicitTransferSyntax};
  return syntaxes;
}

std::string reason_of(const OFCondition& condition) {
  if (condition == DUL_PEERABORTEDASSOCIATION || condition == DUL_NETWORKCLOSED ||
      condition == DUL_PEERREQUESTEDRELEASE)
    return std::string(kPeerEnded);
  if (condition == DIMSE_NODATAAVAILABLE || condition == DUL_READTIMEOUT) return "the peer does not answer";
  std::string text = condition.text();
  // "DIMSE Failed to send message 0006:031d TCP I/O Error (Connection reset by peer) occurred in routine:
  // ..."
  if (const auto at = text.find("I/O Error ("); at != std::string::npos) {
    const std::size_t from = at + 11;
    return std::string(kBroke) + ": " + text.substr(from, text.find(')', from) - from);
  }
  // "TCP Initialization Error: Connection refused" and the like.
  if (const auto at = text.rfind("Error: "); at != std::string::npos) text = text.substr(at + 7);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string take_comment(DcmDataset*& status_detail) {
  if (status_detail == nullptr) return "";
  OFString comment;
  (void)status_detail->findAndGetOFString(DCM_ErrorComment, comment);
  delete status_detail;
  status_detail = nullptr;
  return comment.c_str();
}

std::string status_text(unsigned status, const std::string& comment) {
  const char* meaning = "";
  if (status == 0x0122) meaning = " (not supported)";
  if (status == 0x0124) meaning = " (not authorised)";
  if (status == 0x0110) meaning = " (it failed in processing)";
  if (status == 0x0111) meaning = " (it has that already)";
  if (status == 0x0112) meaning = " (no such object)";
  if (status == 0x0211) meaning = " (unrecognised operation)";
  if (status == 0xA801) meaning = " (it does not know where to send)";
  if ((status & 0xFF00U) == 0xA700) meaning = " (it is out of resources, as with a full disk)";
  if ((status & 0xFF00U) == 0xA900) meaning = " (the data are not of the class that they name)";
  if ((status & 0xF000U) == 0xC000) meaning = " (it cannot understand or process that)";
  return files::format("status 0x%04X", status) + meaning + (comment.empty() ? "" : ": " + comment);
}

void pause_before_retry(const ConnectionOptions& options, int attempt, const std::string& reason,
                        const std::stop_token& stop) {
  const std::chrono::duration<double> pause(
      std::min(options.first_pause_s * std::pow(2.0, std::min(attempt, 10)), kLongestPause_s));
  if (options.on_retry) options.on_retry({.reason = reason, .number = attempt + 1, .pause_s = pause.count()});
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  (void)never.wait_for(lock, stop, pause, [] { return false; });
}

std::unique_ptr<Association> Association::connect(const Peer& peer, const ConnectionOptions& options,
                                                  const std::vector<Proposal>& proposals,
                                                  const std::stop_token& stop) {
  check(options);
  prepare_network(options);
  for (int attempt = 0; !stop.stop_requested(); ++attempt) {
    // NOLINTNEXTLINE: the constructor is private
    std::unique_ptr<Association> association(new Association(options));
    CuttableSocket& socket = association->line_.socket;
    association->cut_when_stopped_.emplace(stop, [&socket] { socket.cut(); });
    const OFCondition outcome = association->request(peer, options, proposals);
    if (outcome.good()) return association;
    if (stop.stop_requested()) break;
    Refusal refusal{.reason = "cannot be reached: " + association->why(outcome), .is_for_good = false};
    if (outcome == DUL_PEERABORTEDASSOCIATION || outcome == DUL_NETWORKCLOSED)
      refusal.reason =
          options.tls ? "ended the connection while it began; it may not speak TLS there, or not trust us"
                      : "ended the connection while it began; it may speak TLS alone there";
    // Who refuses our certificate may close with our word unread, so that his reason is lost.
    if (options.tls && refusal.reason.find(kBroke) != std::string::npos)
      refusal.reason += "; it may not trust our certificate, or not speak TLS there";
    if (outcome.module() == OFM_dcmtls)
      refusal.reason =
          "did not begin TLS: it may not speak TLS there (then leave TLS out), or not trust our "
          "certificate (" +
          association->why(outcome) + ")";
    if (outcome == DUL_ASSOCIATIONREJECTED) {
      T_ASC_RejectParameters reject{};
      ASC_getRejectParameters(association->association_->params, &reject);
      refusal = refusal_of(reject, peer, options);
    }
    if (association->secure_ && !association->secure_->refusal().empty())
      refusal = {.reason = association->secure_->refusal(), .is_for_good = true};
    if (refusal.is_for_good || attempt >= options.retries)
      throw DeviceError(to_text(peer) + ": " + refusal.reason +
                        (attempt == 0 ? "" : " (tried " + std::to_string(attempt + 1) + " times)"));
    pause_before_retry(options, attempt, refusal.reason, stop);
  }
  return nullptr;
}

OFCondition Association::request(const Peer& peer, const ConnectionOptions& options,
                                 const std::vector<Proposal>& proposals) {
  answer_timeout_s_ = whole_seconds(options.answer_timeout_s);
  OFCondition outcome =
      ASC_initializeNetwork(NET_REQUESTOR, 0, whole_seconds(options.connect_timeout_s), &network_);
  if (outcome.bad()) return outcome;
  if (options.tls) {
    secure_ = std::make_unique<SecureLayer>(*options.tls, NET_REQUESTOR, peer.host);
    secure_->layer().use(line_);
  } else {
    plain_ = std::make_unique<LineLayer<DcmTransportLayer>>();
    plain_->use(line_);
  }
  DcmTransportLayer* layer = plain_.get();
  if (secure_) layer = &secure_->layer();
  outcome = ASC_setTransportLayer(network_, layer, 0);
  if (outcome.bad()) return outcome;
  T_ASC_Parameters* parameters = nullptr;
  outcome = ASC_createAssociationParameters(&parameters, kLargestPdu_bytes);
  if (outcome.bad()) return outcome;
  ASC_setAPTitles(parameters, options.our_ae_title.c_str(), peer.ae_title.c_str(), nullptr);
  ASC_setTransportLayerType(parameters, options.tls ? OFTrue : OFFalse);
  ASC_setPresentationAddresses(parameters, OFStandard::getHostName().c_str(),
                               (peer.host + ":" + std::to_string(peer.port)).c_str());
  int id = 1;
  for (const Proposal& proposal : proposals) {
    std::vector<const char*> syntaxes;
    for (const std::string& syntax : proposal.transfer_syntaxes) syntaxes.push_back(syntax.c_str());
    outcome = ASC_addPresentationContext(
        parameters, static_cast<T_ASC_PresentationContextID>(id), proposal.sop_class.c_str(), syntaxes.data(),
        static_cast<int>(syntaxes.size()), proposal.we_are_provider ? ASC_SC_ROLE_SCP : ASC_SC_ROLE_DEFAULT);
    if (outcome.bad()) {
      ASC_destroyAssociationParameters(&parameters);
      return outcome;
    }
    id += 2;
  }
  line_.allowance.allow(kLargestRemark_bytes, "it answers the first word with more than 16 MB");
  // TLS shakes hands below what the allowance sees.
  const CutAfter cut(line_, std::chrono::duration<double>(kConnectTimeouts * options.connect_timeout_s));
  outcome = ASC_requestAssociation(network_, parameters, &association_);
  is_established_ = outcome.good();
  return outcome;
}

Association::~Association() {
  cut_when_stopped_.reset();  // waits for one that runs
  if (is_established_) abort();
  if (association_ != nullptr) ASC_destroyAssociation(&association_);
  if (network_ != nullptr) ASC_dropNetwork(&network_);
}

void Association::abort() {
  // DCMTK waits until the peer closes the connection, which one that is sending does late: not longer than
  // so.
  const CutAfter cut(line_, kLongestFarewell);
  ASC_abortAssociation(association_);
}

std::string Association::why(const OFCondition& outcome) const {
  const std::string& complaint = line_.allowance.complaint();
  return complaint.empty() ? reason_of(outcome) : "was cut off: " + complaint;
}

void Association::release() {
  line_.allowance.allow(kLargestRemark_bytes, kTooLargeCommand);
  if (is_established_ && ASC_releaseAssociation(association_).good()) is_established_ = false;
}

T_ASC_PresentationContextID Association::accepted(const std::string& sop_class) const {
  return ASC_findAcceptedPresentationContextID(association_, sop_class.c_str());
}

T_ASC_PresentationContextID Association::accepted(const std::string& sop_class,
                                                  const std::string& transfer_syntax) const {
  return ASC_findAcceptedPresentationContextID(association_, sop_class.c_str(), transfer_syntax.c_str());
}

}  // namespace arthronaut::pacs
