#include "tests/planning/pacs/hostile_peer.h"

#include <dcmtk/dcmnet/diutil.h>

#include <memory>
#include <stdexcept>

#include "tests/planning/pacs/orthanc.h"

namespace arthronaut::test {

namespace {

constexpr int kPoll_s = 1, kTimeout_s = 10;

void accept_all(T_ASC_Association& association) {
  const int count = ASC_countPresentationContexts(association.params);
  for (int i = 0; i < count; ++i) {
    T_ASC_PresentationContext context{};
    (void)ASC_getPresentationContext(association.params, i, &context);
    (void)ASC_acceptPresentationContext(association.params, context.presentationContextID,
                                        context.proposedTransferSyntaxes[0], context.proposedRole);
  }
}

bool has_data(const T_DIMSE_Message& message) {
  switch (message.CommandField) {
    case DIMSE_C_FIND_RQ:
      return message.msg.CFindRQ.DataSetType == DIMSE_DATASET_PRESENT;
    case DIMSE_C_GET_RQ:
      return message.msg.CGetRQ.DataSetType == DIMSE_DATASET_PRESENT;
    case DIMSE_C_STORE_RQ:
      return message.msg.CStoreRQ.DataSetType == DIMSE_DATASET_PRESENT;
    case DIMSE_N_ACTION_RQ:
      return message.msg.NActionRQ.DataSetType == DIMSE_DATASET_PRESENT;
    default:
      return false;
  }
}

}  // namespace

HostilePeer::HostilePeer(Habit habit) : habit_(std::move(habit)), port_(free_port()) {
  OFStandard::initializeNetwork();
  if (ASC_initializeNetwork(NET_ACCEPTOR, port_, kTimeout_s, &network_).bad())
    throw std::runtime_error("no port for the hostile peer");
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

HostilePeer::~HostilePeer() {
  thread_.request_stop();
  (void)listens(port_);  // a caller ends its wait for one
  thread_.join();
  ASC_dropNetwork(&network_);
}

void HostilePeer::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (!ASC_associationWaiting(network_, kPoll_s)) continue;
    T_ASC_Association* association = nullptr;
    if (ASC_receiveAssociation(network_, &association, ASC_MAXIMUMPDUSIZE).good()) {
      accept_all(*association);
      if (ASC_acknowledgeAssociation(association).good()) serve(*association, stop);
    }
    if (association == nullptr) continue;
    ASC_dropSCPAssociation(association, kPoll_s);
    ASC_destroyAssociation(&association);
  }
}

void HostilePeer::serve(T_ASC_Association& association, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (!ASC_dataWaiting(&association, kPoll_s)) continue;
    T_DIMSE_Message message{};
    T_ASC_PresentationContextID context = 0;
    DcmDataset* detail = nullptr;
    const OFCondition outcome =
        DIMSE_receiveCommand(&association, DIMSE_NONBLOCKING, kTimeout_s, &context, &message, &detail);
    delete detail;
    if (outcome == DUL_PEERREQUESTEDRELEASE) (void)ASC_acknowledgeRelease(&association);
    if (outcome.bad()) return;
    DcmDataset* data = nullptr;
    T_ASC_PresentationContextID data_context = context;
    if (has_data(message) && DIMSE_receiveDataSetInMemory(&association, DIMSE_NONBLOCKING, kTimeout_s,
                                                          &data_context, &data, nullptr, nullptr)
                                 .bad())
      return;
    const std::unique_ptr<DcmDataset> owned(data != nullptr ? data : new DcmDataset());
    Request request{association, context, message, *owned};
    if (!habit_(request)) return;
  }
}

bool answer_find(const HostilePeer::Request& request, DcmDataset* answer, unsigned status) {
  T_DIMSE_C_FindRSP response{};
  response.MessageIDBeingRespondedTo = request.message.msg.CFindRQ.MessageID;
  response.DimseStatus = static_cast<DIC_US>(status);
  response.DataSetType = answer != nullptr ? DIMSE_DATASET_PRESENT : DIMSE_DATASET_NULL;
  return DIMSE_sendFindResponse(&request.association, request.context, &request.message.msg.CFindRQ,
                                &response, answer, nullptr)
      .good();
}

unsigned store(const HostilePeer::Request& request, DcmDataset& image) {
  OFString sop_class, uid;
  image.findAndGetOFString(DCM_SOPClassUID, sop_class);
  image.findAndGetOFString(DCM_SOPInstanceUID, uid);
  T_DIMSE_C_StoreRQ store{};
  static std::atomic<DIC_US> last_id = 100;
  store.MessageID = ++last_id;
  OFStandard::strlcpy(store.AffectedSOPClassUID, sop_class.c_str(), DIC_UI_LEN + 1);
  OFStandard::strlcpy(store.AffectedSOPInstanceUID, uid.c_str(), DIC_UI_LEN + 1);
  store.DataSetType = DIMSE_DATASET_PRESENT;
  T_DIMSE_C_StoreRSP response{};
  DcmDataset* detail = nullptr;
  const auto context = ASC_findAcceptedPresentationContextID(&request.association, sop_class.c_str());
  const OFCondition outcome = DIMSE_storeUser(&request.association, context, &store, nullptr, &image, nullptr,
                                              nullptr, DIMSE_NONBLOCKING, kTimeout_s, &response, &detail);
  delete detail;
  return outcome.good() ? response.DimseStatus : 0xFFFF;
}

bool take_file(const HostilePeer::Request& request) {
  T_DIMSE_C_StoreRSP response{};
  response.MessageIDBeingRespondedTo = request.message.msg.CStoreRQ.MessageID;
  response.DataSetType = DIMSE_DATASET_NULL;
  return DIMSE_sendStoreResponse(&request.association, request.context, &request.message.msg.CStoreRQ,
                                 &response, nullptr)
      .good();
}

bool report_commitment(const HostilePeer::Request& request, DcmDataset& data) {
  T_DIMSE_Message report{};
  report.CommandField = DIMSE_N_EVENT_REPORT_RQ;
  T_DIMSE_N_EventReportRQ& event = report.msg.NEventReportRQ;
  event.MessageID = 7;
  event.EventTypeID = 1;
  event.DataSetType = DIMSE_DATASET_PRESENT;
  OFStandard::strlcpy(event.AffectedSOPClassUID, UID_StorageCommitmentPushModelSOPClass, DIC_UI_LEN + 1);
  OFStandard::strlcpy(event.AffectedSOPInstanceUID, UID_StorageCommitmentPushModelSOPInstance,
                      DIC_UI_LEN + 1);
  return DIMSE_sendMessageUsingMemoryData(&request.association, request.context, &report, nullptr, &data,
                                          nullptr, nullptr)
      .good();
}

void end_get(const HostilePeer::Request& request, int failed) {
  T_DIMSE_C_GetRSP response{};
  response.MessageIDBeingRespondedTo = request.message.msg.CGetRQ.MessageID;
  response.DimseStatus = failed > 0 ? 0xB000 : STATUS_Success;
  response.DataSetType = DIMSE_DATASET_NULL;
  response.NumberOfFailedSubOperations = static_cast<DIC_US>(failed);
  response.opts = O_GET_NUMBEROFFAILEDSUBOPERATIONS;
  (void)DIMSE_sendGetResponse(&request.association, request.context, &request.message.msg.CGetRQ, &response,
                              nullptr, nullptr);
}

}  // namespace arthronaut::test
