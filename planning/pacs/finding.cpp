#include "planning/pacs/finding.h"

#include <algorithm>
#include <charconv>
#include <chrono>

#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"

namespace arthronaut::pacs {

namespace {

// Some hundred short texts.
constexpr std::int64_t kLargestAnswer_bytes = 1024 * 1024;
constexpr const char* kTooLargeAnswer = "it answers a search with more than 1 MB at once";
// What may still come after it was asked to stop.
constexpr int kMostAfterCancel = 1000;
constexpr int kTimeoutsOfASearch = 10;

struct Reception {
  Association* association;
  T_ASC_PresentationContextID context;
  int most;
  std::chrono::steady_clock::time_point until;
  bool is_cut = false, is_over = false;
  const std::function<void(DcmDataset&)>* take;
};

void take_answer(void* data, T_DIMSE_C_FindRQ* request, int count, T_DIMSE_C_FindRSP* /*response*/,
                 DcmDataset* answer) {
  auto& reception = *static_cast<Reception*>(data);
  Line& line = reception.association->line();
  line.allowance.allow(kLargestAnswer_bytes, kTooLargeAnswer);
  if (std::chrono::steady_clock::now() > reception.until) {
    line.allowance.complain("its search takes too long", true);
    line.socket.cut();
    return;
  }
  if (count > reception.most) {
    if (count - reception.most > kMostAfterCancel) {
      reception.is_over = true;
      line.socket.cut();
      return;
    }
    // The peer may send what is on its way already.
    if (!reception.is_cut)
      (void)DIMSE_sendCancelRequest(&reception.association->get(), reception.context, request->MessageID);
    reception.is_cut = true;
    return;
  }
  if (answer != nullptr) (*reception.take)(*answer);
}

}  // namespace

void propose_find(std::vector<Proposal>& proposals) {
  proposals.push_back({.sop_class = UID_FINDStudyRootQueryRetrieveInformationModel,
                       .transfer_syntaxes = uncompressed_syntaxes()});
  proposals.push_back({.sop_class = UID_FINDPatientRootQueryRetrieveInformationModel,
                       .transfer_syntaxes = uncompressed_syntaxes()});
}

void put_key(DcmDataset& query, const DcmTagKey& key, const std::string& value) {
  const bool is_ascii = std::all_of(value.begin(), value.end(), [](char c) { return (c & 0x80) == 0; });
  if (!is_ascii) query.putAndInsertString(DCM_SpecificCharacterSet, "ISO_IR 192");
  const OFCondition outcome =
      value.empty() ? query.insertEmptyElement(key, OFFalse) : query.putAndInsertString(key, value.c_str());
  if (outcome.bad())
    throw InvalidInput(std::string("the search for ") + DcmTag(key).getTagName() + " \"" + value +
                       "\" cannot be asked: " + outcome.text());
}

int count_of(DcmItem& answer, const DcmTagKey& key) {
  const std::string text = images::text_of(answer, key);
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value >= 0 ? value : -1;
}

FindOutcome send_find(Association& association, DcmDataset& query, int most,
                      const std::function<void(DcmDataset&)>& take) {
  const char* model = UID_FINDStudyRootQueryRetrieveInformationModel;
  T_ASC_PresentationContextID context = association.accepted(model);
  if (context == 0) {
    model = UID_FINDPatientRootQueryRetrieveInformationModel;
    context = association.accepted(model);
  }
  if (context == 0) return {.refusal = "does not offer C-FIND to us"};
  T_DIMSE_C_FindRQ request{};
  request.MessageID = association.next_message_id();
  OFStandard::strlcpy(request.AffectedSOPClassUID, model, DIC_UI_LEN + 1);
  request.Priority = DIMSE_PRIORITY_MEDIUM;
  request.DataSetType = DIMSE_DATASET_PRESENT;
  T_DIMSE_C_FindRSP response{};
  DcmDataset* detail = nullptr;
  int count = 0;
  Reception reception{.association = &association,
                      .context = context,
                      .most = most,
                      .until = std::chrono::steady_clock::now() +
                               std::chrono::seconds(kTimeoutsOfASearch * association.answer_timeout_s()),
                      .take = &take};
  association.line().allowance.allow(kLargestAnswer_bytes, kTooLargeAnswer);
  const OFCondition outcome =
      DIMSE_findUser(&association.get(), context, &request, &query, count, take_answer, &reception,
                     DIMSE_NONBLOCKING, association.answer_timeout_s(), &response, &detail);
  const std::string comment = take_comment(detail);
  if (reception.is_over) return {.is_cut = true, .is_over = true};
  if (outcome.bad())
    return {.is_broken = !association.is_given_up_for_good(), .refusal = association.why(outcome)};
  if (reception.is_cut) return {.is_cut = true};
  if (response.DimseStatus != STATUS_Success)
    return {.refusal = "refused C-FIND with " + status_text(response.DimseStatus, comment)};
  return {};
}

}  // namespace arthronaut::pacs
