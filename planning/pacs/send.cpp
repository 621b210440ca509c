#include "planning/pacs/send.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmnet/diutil.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"
#include "planning/pacs/association.h"
#include "planning/pacs/commitment.h"
#include "planning/pacs/dcmtk_log.h"

namespace arthronaut::pacs {

namespace fs = std::filesystem;

namespace {

constexpr unsigned kWarningMask = 0xF000, kWarning = 0xB000;

struct Loaded {
  DcmFileFormat format;
  std::string transfer_syntax;
};

// The head, up to what says in words what it is; or all of it. Throws InvalidInput.
void load(const fs::path& file, bool is_whole, Loaded& loaded) {
  const OFFilename name(file.c_str());
  const OFCondition outcome =
      is_whole ? loaded.format.loadFile(name, EXS_Unknown, EGL_noChange, DCM_MaxReadLength, ERM_fileOnly)
               : loaded.format.loadFileUntilTag(name, EXS_Unknown, EGL_noChange, DCM_MaxReadLength,
                                                ERM_fileOnly, DCM_PresentationCreationDate);
  if (outcome.bad()) throw InvalidInput(file, "", std::string("broken or cut off: ") + outcome.text());
  loaded.transfer_syntax = DcmXfer(loaded.format.getDataset()->getOriginalXfer()).getXferID();
}

// What kind of thing it is, for people: DICOM's own name for what we do not write.
std::string kind_of(const std::string& sop_class) {
  if (sop_class == UID_EncapsulatedSTLStorage) return "Model";
  if (sop_class == UID_EncapsulatedPDFStorage) return "Document";
  if (sop_class == UID_SecondaryCaptureImageStorage) return "Picture";
  if (sop_class == UID_SpatialFiducialsStorage) return "Points";
  std::string name = dcmFindNameOfUID(sop_class.c_str(), "object");
  if (const auto at = name.rfind("Storage"); at != std::string::npos && at > 0) name.erase(at);
  return name;
}

std::string title_of(DcmDataset& dataset, const std::string& sop_class) {
  // The words for this one object, else those of all its series.
  for (const DcmTagKey& key :
       {DCM_DocumentTitle, DCM_ContentDescription, DCM_ImageComments, DCM_SeriesDescription})
    if (const auto words = images::utf8_text_of(dataset, key); !words.empty())
      return kind_of(sop_class) + ": " + words;
  return kind_of(sop_class);
}

SentFile described(const fs::path& file) {
  if (!images::has_dicom_mark(file)) throw InvalidInput(file, "", "is not a DICOM file");
  Loaded loaded;
  load(file, false, loaded);
  SentFile described;
  described.file = file;
  described.sop_class_uid = images::text_of(*loaded.format.getDataset(), DCM_SOPClassUID);
  described.sop_instance_uid = images::text_of(*loaded.format.getDataset(), DCM_SOPInstanceUID);
  DcmDataset& dataset = *loaded.format.getDataset();
  described.patient_name = images::utf8_text_of(dataset, DCM_PatientName);
  described.patient_id = images::utf8_text_of(dataset, DCM_PatientID);
  described.birth_date = images::text_of(dataset, DCM_PatientBirthDate);
  described.title = title_of(dataset, described.sop_class_uid);
  if (!is_uid(described.sop_class_uid) || !is_uid(described.sop_instance_uid))
    throw InvalidInput(file, "", "does not say which object of which class it is; a DICOMDIR is not sent");
  return described;
}

std::vector<fs::path> dicom_files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  // Links to folders are not followed: they may lead round.
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != "DICOMDIR" &&
        images::has_dicom_mark(entry.path()))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty()) throw InvalidInput(folder, "", "holds no DICOM file");
  return files;
}

bool is_uncompressed(const std::string& syntax) { return !DcmXfer(syntax.c_str()).isEncapsulated(); }

class Sending {
 public:
  Sending(const Peer& peer, const ConnectionOptions& connection, const OnProgress& on_progress,
          const std::stop_token& stop, SendSummary& summary)
      : peer_(peer), connection_(connection), on_progress_(on_progress), stop_(stop), summary_(summary) {}

  // False when stopped.
  bool run() {
    pending_.resize(summary_.files.size());
    for (std::size_t i = 0; i < pending_.size(); ++i) pending_[i] = i;
    for (int fruitless = 0; !pending_.empty();) {
      const std::size_t before = pending_.size();
      std::string reason;
      const bool is_unbroken = send_some(reason);
      if (stop_.stop_requested()) return false;
      if (is_unbroken) continue;
      fruitless = pending_.size() < before ? 0 : fruitless + 1;
      if (fruitless > connection_.retries)
        throw DeviceError(to_text(peer_) + ": broke off at " +
                          summary_.files[pending_.front()].file.string() + ": " + reason);
      pause_before_retry(connection_, fruitless, reason, stop_);
    }
    return true;
  }

 private:
  // A context for each class and encoding, as many files as have room. Throws InvalidInput.
  std::vector<Proposal> proposals() {
    std::vector<Proposal> proposals;
    std::set<std::pair<std::string, std::string>> known;
    for (const std::size_t i : pending_) {
      const SentFile& file = summary_.files[i];
      Loaded loaded;
      load(file.file, false, loaded);
      std::vector<std::string> syntaxes{loaded.transfer_syntax};
      if (is_uncompressed(loaded.transfer_syntax)) syntaxes = uncompressed_syntaxes();
      if (!known.emplace(file.sop_class_uid, syntaxes.front()).second) continue;
      if (proposals.size() == kMostProposals) break;
      proposals.push_back({.sop_class = file.sop_class_uid, .transfer_syntaxes = std::move(syntaxes)});
    }
    return proposals;
  }

  // Over one association; what is done leaves the pending. False when that broke.
  bool send_some(std::string& reason) {
    const std::vector<Proposal> offered = proposals();
    const auto association = Association::connect(peer_, connection_, offered, stop_);
    if (!association) return false;
    while (!pending_.empty()) {
      SentFile& file = summary_.files[pending_.front()];
      Loaded loaded;
      load(file.file, true, loaded);
      const bool was_offered = std::any_of(offered.begin(), offered.end(), [&](const Proposal& proposal) {
        return proposal.sop_class == file.sop_class_uid &&
               (is_uncompressed(loaded.transfer_syntax)
                    ? is_uncompressed(proposal.transfer_syntaxes.front())
                    : proposal.transfer_syntaxes.front() == loaded.transfer_syntax);
      });
      if (!was_offered) break;  // the next association
      if (!send_one(*association, file, loaded, reason)) return false;
      pending_.erase(pending_.begin());
      if (on_progress_)
        on_progress_({.done = static_cast<int>(summary_.files.size() - pending_.size()),
                      .total = static_cast<int>(summary_.files.size()),
                      .bytes = sent_bytes_});
      if (stop_.stop_requested()) return false;
    }
    association->release();
    return true;
  }

  bool send_one(Association& association, SentFile& file, Loaded& loaded, std::string& reason) {
    if (!is_unchanged(file)) {
      file.note = kChanged;
      return true;
    }
    const T_ASC_PresentationContextID context =
        association.accepted(file.sop_class_uid, loaded.transfer_syntax);
    T_ASC_PresentationContext negotiated{};
    const bool is_taken =
        context != 0 &&
        ASC_findAcceptedPresentationContext(association.get().params, context, &negotiated).good() &&
        loaded.format.getDataset()->canWriteXfer(DcmXfer(negotiated.acceptedTransferSyntax).getXfer());
    if (!is_taken) {
      file.note = std::string("the peer does not take ") +
                  dcmFindNameOfUID(file.sop_class_uid.c_str(), file.sop_class_uid.c_str()) + " in " +
                  DcmXfer(loaded.transfer_syntax.c_str()).getXferName();
      return true;
    }
    T_DIMSE_C_StoreRQ request{};
    request.MessageID = association.next_message_id();
    OFStandard::strlcpy(request.AffectedSOPClassUID, file.sop_class_uid.c_str(), DIC_UI_LEN + 1);
    OFStandard::strlcpy(request.AffectedSOPInstanceUID, file.sop_instance_uid.c_str(), DIC_UI_LEN + 1);
    request.DataSetType = DIMSE_DATASET_PRESENT;
    request.Priority = DIMSE_PRIORITY_MEDIUM;
    association.expect_command();
    T_DIMSE_C_StoreRSP response{};
    DcmDataset* detail = nullptr;
    const OFCondition outcome =
        DIMSE_storeUser(&association.get(), context, &request, nullptr, loaded.format.getDataset(), nullptr,
                        nullptr, DIMSE_NONBLOCKING, association.answer_timeout_s(), &response, &detail);
    const std::string comment = take_comment(detail);
    if (outcome.bad()) {
      reason = association.why(outcome);
      return false;
    }
    const bool is_warning = (response.DimseStatus & kWarningMask) == kWarning;
    file.is_stored = response.DimseStatus == STATUS_Success || is_warning;
    if (is_warning) file.note = "stored, with " + status_text(response.DimseStatus, comment);
    if (!file.is_stored) file.note = "refused with " + status_text(response.DimseStatus, comment);
    sent_bytes_ += static_cast<std::int64_t>(fs::file_size(file.file));
    return true;
  }

  const Peer& peer_;
  const ConnectionOptions& connection_;
  const OnProgress& on_progress_;
  const std::stop_token& stop_;
  SendSummary& summary_;
  std::vector<std::size_t> pending_;
  std::int64_t sent_bytes_ = 0;
};

}  // namespace

const char* to_text(Commitment commitment) {
  switch (commitment) {
    case Commitment::NotAsked:
      return "not asked for";
    case Commitment::NotSupported:
      return "not supported";
    case Commitment::Awaited:
      return "awaited";
    case Commitment::Confirmed:
      return "confirmed";
    case Commitment::Failed:
      return "failed";
  }
  return "";
}

std::vector<SentFile> files_to_send(const std::vector<fs::path>& paths) {
  if (paths.empty()) throw InvalidInput("nothing to send");
  silence_dcmtk();
  std::vector<SentFile> files;
  std::map<std::string, fs::path> known;
  const auto add = [&](const fs::path& path) {
    SentFile file = described(path);
    const auto [at, is_new] = known.emplace(file.sop_instance_uid, path);
    if (!is_new) throw InvalidInput(path, "", "says that it is the same object as " + at->second.string());
    files.push_back(std::move(file));
  };
  for (const fs::path& path : paths) {
    if (!fs::exists(path)) throw InvalidInput(path, "", "does not exist");
    if (!fs::is_directory(path)) {
      add(path);
      continue;
    }
    for (const fs::path& file : dicom_files_of(path)) add(file);
  }
  return files;
}

bool is_unchanged(const SentFile& file) {
  const SentFile now = described(file.file);
  return now.sop_class_uid == file.sop_class_uid && now.sop_instance_uid == file.sop_instance_uid &&
         now.patient_name == file.patient_name && now.patient_id == file.patient_id;
}

bool end_broken_off(const std::exception& error, SendSummary& summary) {
  const bool is_some = std::any_of(summary.files.begin(), summary.files.end(),
                                   [](const SentFile& file) { return file.is_stored; });
  if (!is_some) return false;
  summary.outcome = SendSummary::Outcome::BrokenOff;
  summary.failure = error.what();
  if (summary.commitment == Commitment::NotAsked)
    summary.commitment_note = "sending ended before all was sent";
  // The first that has no answer was on its way: the peer may have it.
  bool was_on_its_way = true;
  for (SentFile& file : summary.files) {
    if (file.is_stored || !file.note.empty()) continue;
    file.note =
        std::exchange(was_on_its_way, false) ? std::string("not confirmed: ") + error.what() : "not sent";
  }
  return true;
}

SendSummary send_files(const Peer& peer, const ConnectionOptions& connection,
                       const std::vector<SentFile>& files, const SendOptions& options,
                       const OnProgress& on_progress, const std::stop_token& stop) {
  check(connection);
  if (!(options.commitment_wait_s >= 0 && options.commitment_wait_s <= 86400))
    throw InvalidInput("commitment_wait_s: must be between 0 and 86400 seconds");
  SendSummary summary;
  summary.files = files;
  try {
    if (!Sending(peer, connection, on_progress, stop, summary).run()) {
      summary.outcome = SendSummary::Outcome::Stopped;
      return summary;
    }
  } catch (
      const std::runtime_error& error) {  // of the line; or of a file that was whole when it was looked at
    if (!end_broken_off(error, summary)) throw;
    return summary;
  }
  const auto is_stored = [](const SentFile& file) { return file.is_stored; };
  summary.outcome = std::all_of(summary.files.begin(), summary.files.end(), is_stored)
                        ? SendSummary::Outcome::Stored
                        : SendSummary::Outcome::SomeRefused;
  if (options.asks_commitment && std::any_of(summary.files.begin(), summary.files.end(), is_stored)) {
    try {  // whatever becomes of it, what is stored is stored
      ask_commitment(peer, connection, options, summary, stop);
    } catch (const DeviceError& error) {
      summary.commitment = Commitment::NotAsked;
      summary.commitment_note = std::string("could not be asked for: ") + error.what();
    }
  }
  return summary;
}

}  // namespace arthronaut::pacs
