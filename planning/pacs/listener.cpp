#include "planning/pacs/listener.h"

#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmnet/diutil.h>

#include <cmath>
#include <list>

#include "planning/geometry/error.h"
#include "planning/pacs/association.h"
#include "planning/pacs/storing.h"

namespace arthronaut::pacs {

namespace {

constexpr int kPoll_s = 1;

// Every transfer syntax that was proposed will do: nothing is decoded here.
OFCondition accept_contexts(T_ASC_Association& association, bool takes_images, bool takes_reports) {
  const int count = ASC_countPresentationContexts(association.params);
  for (int i = 0; i < count; ++i) {
    T_ASC_PresentationContext context{};
    OFCondition outcome = ASC_getPresentationContext(association.params, i, &context);
    if (outcome.bad()) return outcome;
    const std::string sop_class = context.abstractSyntax;
    const bool is_wanted = sop_class == UID_VerificationSOPClass ||
                           (takes_reports && sop_class == UID_StorageCommitmentPushModelSOPClass) ||
                           (takes_images && dcmIsaStorageSOPClassUID(context.abstractSyntax));
    outcome = is_wanted && context.transferSyntaxCount > 0
                  ? ASC_acceptPresentationContext(association.params, context.presentationContextID,
                                                  context.proposedTransferSyntaxes[0], context.proposedRole)
                  : ASC_refusePresentationContext(association.params, context.presentationContextID,
                                                  ASC_P_ABSTRACTSYNTAXNOTSUPPORTED);
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

}  // namespace

OFCondition receive_commitment_report(T_ASC_Association& association, T_ASC_PresentationContextID context,
                                      const T_DIMSE_N_EventReportRQ& request, int timeout_s,
                                      const std::function<void(int, DcmDataset&)>& take) {
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
  if (!secure_) plain_ = std::make_unique<CuttableLayer<DcmTransportLayer>>(nullptr);
  outcome = ASC_setTransportLayer(network_, secure_ ? &secure_->layer() : plain_.get(), 0);
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

void Listener::accept(const std::stop_token& stop) {
  std::list<std::jthread> servers;  // joined at the end, each of them stopped
  while (!stop.stop_requested()) {
    if (!ASC_associationWaiting(network_, kPoll_s)) continue;
    T_ASC_Association* association = nullptr;
    OFCondition outcome = ASC_receiveAssociation(network_, &association, ASC_MAXIMUMPDUSIZE, nullptr, nullptr,
                                                 secure_ ? OFTrue : OFFalse);
    if (outcome.good() && !calls_us(*association, options_.our_ae_title)) {
      const T_ASC_RejectParameters reject{ASC_RESULT_REJECTEDPERMANENT, ASC_SOURCE_SERVICEUSER,
                                          ASC_REASON_SU_CALLEDAETITLENOTRECOGNIZED};
      (void)ASC_rejectAssociation(association, &reject);
      outcome = DUL_ASSOCIATIONREJECTED;
    }
    if (outcome.good())
      outcome = accept_contexts(*association, handlers_.series != nullptr, bool(handlers_.on_commitment));
    if (outcome.good()) outcome = ASC_acknowledgeAssociation(association);
    if (outcome.bad()) {
      if (association != nullptr) {
        ASC_dropSCPAssociation(association, kPoll_s);
        ASC_destroyAssociation(&association);
      }
      continue;
    }
    servers.emplace_back([this, association](const std::stop_token& ends) {
      T_ASC_Association* served = association;
      serve(*served, ends);
      ASC_dropSCPAssociation(served, kPoll_s);
      ASC_destroyAssociation(&served);
    });
  }
}

void Listener::serve(T_ASC_Association& association, const std::stop_token& stop) {
  const int timeout_s = static_cast<int>(std::ceil(options_.answer_timeout_s));
  while (!stop.stop_requested()) {
    if (!ASC_dataWaiting(&association, kPoll_s)) continue;
    T_DIMSE_Message message{};
    T_ASC_PresentationContextID context = 0;
    DcmDataset* detail = nullptr;
    OFCondition outcome =
        DIMSE_receiveCommand(&association, DIMSE_NONBLOCKING, timeout_s, &context, &message, &detail);
    delete detail;
    if (outcome == DUL_PEERREQUESTEDRELEASE) {
      (void)ASC_acknowledgeRelease(&association);
      return;
    }
    if (outcome.bad()) return;
    if (message.CommandField == DIMSE_C_ECHO_RQ) {
      outcome = DIMSE_sendEchoResponse(&association, context, &message.msg.CEchoRQ, STATUS_Success, nullptr);
    } else if (message.CommandField == DIMSE_C_STORE_RQ && handlers_.series != nullptr) {
      try {
        outcome = receive_image(association, context, message.msg.CStoreRQ, timeout_s, *handlers_.series);
        if (outcome.good() && handlers_.on_image) handlers_.on_image();
      } catch (const IoError& error) {
        const std::scoped_lock lock(mutex_);
        failure_ = error.what();
        outcome = EC_InvalidStream;
      }
    } else if (message.CommandField == DIMSE_N_EVENT_REPORT_RQ) {
      outcome = receive_commitment_report(association, context, message.msg.NEventReportRQ, timeout_s,
                                          handlers_.on_commitment);
    } else {
      outcome = DIMSE_BADCOMMANDTYPE;
    }
    if (outcome.bad()) {
      (void)ASC_abortAssociation(&association);
      return;
    }
  }
  (void)ASC_abortAssociation(&association);
}

}  // namespace arthronaut::pacs
