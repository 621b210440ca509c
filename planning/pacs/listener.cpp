#include "planning/pacs/listener.h"

#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmnet/diutil.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <list>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/pacs/association.h"
#include "planning/pacs/storing.h"

namespace arthronaut::pacs {

namespace {

constexpr int kPoll_s = 1;
// A PACS sends over one or two.
constexpr std::size_t kMostConnections = 16;
constexpr double kLongestIntroduction_s = 5;
// For an answer that is under way when we end.
constexpr std::chrono::milliseconds kLongestFarewell{1500};

// The first of those that were proposed that we can keep; nullptr: none.
const char* syntax_of(const T_ASC_PresentationContext& context) {
  for (int i = 0; i < context.transferSyntaxCount; ++i)
    if (can_be_kept(context.proposedTransferSyntaxes[i])) return context.proposedTransferSyntaxes[i];
  return nullptr;
}

// Nothing is decoded here, except reports.
const char* uncompressed_syntax_of(const T_ASC_PresentationContext& context) {
  const auto& known = uncompressed_syntaxes();
  for (int i = 0; i < context.transferSyntaxCount; ++i)
    if (std::find(known.begin(), known.end(), context.proposedTransferSyntaxes[i]) != known.end())
      return context.proposedTransferSyntaxes[i];
  return nullptr;
}

OFCondition accept_contexts(T_ASC_Association& association, const Listener::Handlers& handlers) {
  const int count = ASC_countPresentationContexts(association.params);
  for (int i = 0; i < count; ++i) {
    T_ASC_PresentationContext context{};
    OFCondition outcome = ASC_getPresentationContext(association.params, i, &context);
    if (outcome.bad()) return outcome;
    const std::string sop_class = context.abstractSyntax;
    const bool is_report = handlers.on_commitment && sop_class == UID_StorageCommitmentPushModelSOPClass;
    const bool is_image = handlers.series != nullptr && can_be_stored(sop_class) &&
                          (handlers.sop_classes.empty() || handlers.sop_classes.contains(sop_class));
    const bool is_wanted = sop_class == UID_VerificationSOPClass || is_report || is_image;
    const char* syntax = is_image ? syntax_of(context) : uncompressed_syntax_of(context);
    outcome = is_wanted && syntax != nullptr
                  ? ASC_acceptPresentationContext(association.params, context.presentationContextID, syntax,
                                                  is_report ? context.proposedRole : ASC_SC_ROLE_DEFAULT)
                  : ASC_refusePresentationContext(
                        association.params, context.presentationContextID,
                        is_wanted ? ASC_P_TRANSFERSYNTAXESNOTSUPPORTED : ASC_P_ABSTRACTSYNTAXNOTSUPPORTED);
    if (outcome.bad()) return outcome;
  }
  return EC_Normal;
}

bool calls_us(T_ASC_Association& association, const std::string& our_title) {
  char calling[DIC_AE_LEN + 1] = {}, called[DIC_AE_LEN + 1] = {};
  return ASC_getAPTitles(association.params, calling, sizeof(calling), called, sizeof(called), nullptr, 0)
             .good() &&
         called == our_title;
}

void reject(T_ASC_Association& association, const T_ASC_RejectParameters& reason) {
  (void)ASC_rejectAssociation(&association, &reason);
}

}  // namespace

// One caller. The line outlives what is on it, and the thread goes first.
struct Listener::Connection {
  explicit Connection(double longest_silence_s) : line(longest_silence_s) {}
  ~Connection() {
    if (thread.joinable()) thread.join();
    if (association == nullptr) return;
    const CutAfter cut(line, kLongestFarewell);
    ASC_dropSCPAssociation(association, kPoll_s);
    ASC_destroyAssociation(&association);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  Line line;
  T_ASC_Association* association = nullptr;
  std::atomic<bool> is_done = false;
  std::jthread thread;
};

OFCondition receive_commitment_report(T_ASC_Association& association, Line& line, std::int64_t largest_bytes,
                                      T_ASC_PresentationContextID context,
                                      const T_DIMSE_N_EventReportRQ& request, int timeout_s,
                                      const std::function<void(int, DcmDataset&)>& take) {
  line.allowance.allow(largest_bytes, files::format("its report of storage commitment is larger than %.0f kB",
                                                    static_cast<double>(largest_bytes) / 1000));
  DcmDataset* data = nullptr;
  if (request.DataSetType == DIMSE_DATASET_PRESENT) {
    T_ASC_PresentationContextID data_context = context;
    const OFCondition outcome = DIMSE_receiveDataSetInMemory(&association, DIMSE_NONBLOCKING, timeout_s,
                                                             &data_context, &data, nullptr, nullptr);
    if (outcome.bad()) return outcome;
  }
  const std::unique_ptr<DcmDataset> report(data);
  const bool is_ours =
      std::string(request.AffectedSOPClassUID) == UID_StorageCommitmentPushModelSOPClass && report != nullptr;
  if (is_ours && take) take(request.EventTypeID, *report);
  T_DIMSE_Message message{};
  message.CommandField = DIMSE_N_EVENT_REPORT_RSP;
  T_DIMSE_N_EventReportRSP& response = message.msg.NEventReportRSP;
  response.MessageIDBeingRespondedTo = request.MessageID;
  response.DimseStatus = is_ours ? STATUS_Success : STATUS_N_NoSuchSOPClass;
  response.DataSetType = DIMSE_DATASET_NULL;
  response.EventTypeID = request.EventTypeID;
  OFStandard::strlcpy(response.AffectedSOPClassUID, request.AffectedSOPClassUID, DIC_UI_LEN + 1);
  OFStandard::strlcpy(response.AffectedSOPInstanceUID, request.AffectedSOPInstanceUID, DIC_UI_LEN + 1);
  response.opts =
      O_NEVENTREPORT_AFFECTEDSOPCLASSUID | O_NEVENTREPORT_AFFECTEDSOPINSTANCEUID | O_NEVENTREPORT_EVENTTYPEID;
  return DIMSE_sendMessageUsingMemoryData(&association, context, &message, nullptr, nullptr, nullptr,
                                          nullptr);
}

Listener::Listener(const ConnectionOptions& options, Handlers handlers)
    : options_(options), handlers_(std::move(handlers)) {
  if (options.tls) secure_ = std::make_unique<SecureLayer>(*options.tls, NET_ACCEPTOR, "");
  const auto fail = [&](const OFCondition& outcome) {
    if (network_ != nullptr) ASC_dropNetwork(&network_);
    throw DeviceError("port " + std::to_string(options_.listening_port) +
                      " cannot be listened at: " + reason_of(outcome));
  };
  OFCondition outcome =
      ASC_initializeNetwork(NET_ACCEPTOR, options.listening_port,
                            static_cast<int>(std::ceil(options.connect_timeout_s)), &network_);
  if (outcome.bad()) fail(outcome);
  if (!secure_) plain_ = std::make_unique<LineLayer<DcmTransportLayer>>();
  DcmTransportLayer* layer = plain_.get();
  if (secure_) layer = &secure_->layer();
  outcome = ASC_setTransportLayer(network_, layer, 0);
  if (outcome.bad()) fail(outcome);
  acceptor_ = std::jthread([this](const std::stop_token& stop) { accept(stop); });
}

Listener::~Listener() {
  acceptor_.request_stop();
  acceptor_.join();
  ASC_dropNetwork(&network_);
}

std::string Listener::failure() const {
  const std::scoped_lock lock(mutex_);
  return failure_;
}

std::string Listener::complaint() const {
  const std::scoped_lock lock(mutex_);
  return complaint_;
}

int Listener::connection_count() const {
  const std::scoped_lock lock(mutex_);
  return connection_count_;
}

void Listener::accept(const std::stop_token& stop) {
  std::list<std::unique_ptr<Connection>> connections;
  while (!stop.stop_requested()) {
    std::erase_if(connections, [](const auto& connection) { return connection->is_done.load(); });
    {
      const std::scoped_lock lock(mutex_);
      connection_count_ = static_cast<int>(connections.size());
    }
    if (!ASC_associationWaiting(network_, kPoll_s)) continue;
    auto connection = next_connection(connections.size());
    if (!connection) continue;
    connection->thread = std::jthread([this, served = connection.get()](const std::stop_token& ends) {
      serve(*served, ends);
      served->is_done = true;
    });
    connections.push_back(std::move(connection));
  }
  for (const auto& connection : connections) connection->thread.request_stop();
  const auto until = std::chrono::steady_clock::now() + kLongestFarewell;
  for (const auto& connection : connections) {
    while (!connection->is_done && std::chrono::steady_clock::now() < until)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (!connection->is_done) connection->line.socket.cut();
  }
}

// nullptr: it was not admitted. `count`: how many are there already.
std::unique_ptr<Listener::Connection> Listener::next_connection(std::size_t count) {
  auto connection = std::make_unique<Connection>(options_.answer_timeout_s);
  if (secure_)
    secure_->layer().use(connection->line);
  else
    plain_->use(connection->line);
  connection->line.allowance.allow(kLargestRemark_bytes, kTooLargeCommand);
  const CutAfter cut(connection->line, std::chrono::duration<double>(
                                           std::min(options_.connect_timeout_s, kLongestIntroduction_s)));
  T_ASC_Association*& association = connection->association;
  OFCondition outcome = ASC_receiveAssociation(network_, &association, ASC_MAXIMUMPDUSIZE, nullptr, nullptr,
                                               secure_ ? OFTrue : OFFalse);
  if (outcome.bad()) return nullptr;
  if (count >= kMostConnections) {
    reject(*association, {ASC_RESULT_REJECTEDTRANSIENT, ASC_SOURCE_SERVICEPROVIDER_PRESENTATION_RELATED,
                          ASC_REASON_SP_PRES_LOCALLIMITEXCEEDED});
    return nullptr;
  }
  if (!calls_us(*association, options_.our_ae_title)) {
    reject(*association,
           {ASC_RESULT_REJECTEDPERMANENT, ASC_SOURCE_SERVICEUSER, ASC_REASON_SU_CALLEDAETITLENOTRECOGNIZED});
    return nullptr;
  }
  outcome = accept_contexts(*association, handlers_);
  if (outcome.good()) outcome = ASC_acknowledgeAssociation(association);
  return outcome.good() ? std::move(connection) : nullptr;
}

void Listener::serve(Connection& connection, const std::stop_token& stop) {
  T_ASC_Association& association = *connection.association;
  const int timeout_s = static_cast<int>(std::ceil(options_.answer_timeout_s));
  auto last_heard = std::chrono::steady_clock::now();
  while (!stop.stop_requested()) {
    // A caller that has nothing to say takes the place of one that has.
    const auto now = std::chrono::steady_clock::now();
    if (now - last_heard > std::chrono::seconds(timeout_s)) break;
    if (!ASC_dataWaiting(&association, kPoll_s)) continue;
    last_heard = now;
    T_DIMSE_Message message{};
    T_ASC_PresentationContextID context = 0;
    DcmDataset* detail = nullptr;
    connection.line.allowance.allow(kLargestCommand_bytes, kTooLargeCommand);
    OFCondition outcome =
        DIMSE_receiveCommand(&association, DIMSE_NONBLOCKING, timeout_s, &context, &message, &detail);
    delete detail;
    if (outcome == DUL_PEERREQUESTEDRELEASE) {
      (void)ASC_acknowledgeRelease(&association);
      return;
    }
    if (outcome.good()) outcome = answer(connection, message, context);
    if (outcome.good()) continue;
    if (const std::string& complaint = connection.line.allowance.complaint(); !complaint.empty()) {
      const std::scoped_lock lock(mutex_);
      complaint_ = complaint;
    }
    break;
  }
  const CutAfter cut(connection.line, kLongestFarewell);
  (void)ASC_abortAssociation(&association);
}

OFCondition Listener::answer(Connection& connection, T_DIMSE_Message& message,
                             T_ASC_PresentationContextID context) {
  T_ASC_Association& association = *connection.association;
  const int timeout_s = static_cast<int>(std::ceil(options_.answer_timeout_s));
  if (message.CommandField == DIMSE_C_ECHO_RQ)
    return DIMSE_sendEchoResponse(&association, context, &message.msg.CEchoRQ, STATUS_Success, nullptr);
  if (message.CommandField == DIMSE_N_EVENT_REPORT_RQ)
    return receive_commitment_report(association, connection.line, handlers_.largest_report_bytes, context,
                                     message.msg.NEventReportRQ, timeout_s, handlers_.on_commitment);
  if (message.CommandField != DIMSE_C_STORE_RQ || handlers_.series == nullptr) return DIMSE_BADCOMMANDTYPE;
  try {
    const OFCondition outcome = receive_image(association, connection.line, context, message.msg.CStoreRQ,
                                              timeout_s, *handlers_.series);
    if (outcome.good() && handlers_.on_image) handlers_.on_image();
    return outcome;
  } catch (const IoError& error) {
    const std::scoped_lock lock(mutex_);
    failure_ = error.what();
    return EC_InvalidStream;
  }
}

}  // namespace arthronaut::pacs
