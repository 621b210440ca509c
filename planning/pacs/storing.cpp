#include "planning/pacs/storing.h"

#include <dcmtk/dcmdata/dcostrma.h>
#include <dcmtk/dcmdata/dcostrmb.h>
#include <dcmtk/dcmdata/dctk.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <vector>

#include "planning/geometry/error.h"
#include "planning/pacs/association.h"
#include "planning/pacs/connection.h"

namespace arthronaut::pacs {

namespace fs = std::filesystem;

namespace {

// Read to its end to be refused in good form; a longer one ends the connection.
constexpr std::int64_t kLargestRefused_bytes = 64 * 1024 * 1024;

constexpr unsigned kOutOfResources = 0xA700, kDoesNotMatch = 0xA900, kCannotUnderstand = 0xC000;

// What DCMTK writes a data set into: a file, whose errors are kept for close(). To DCMTK it never fails:
// where it does, DCMTK goes on to wait for more after the last part of the data set.
class FileConsumer : public DcmConsumer {
 public:
  explicit FileConsumer(const fs::path& file)
      : descriptor_(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600)) {
    if (descriptor_ < 0) error_ = errno;
  }
  ~FileConsumer() override { (void)close(); }
  FileConsumer(const FileConsumer&) = delete;
  FileConsumer& operator=(const FileConsumer&) = delete;

  [[nodiscard]] OFBool good() const override { return OFTrue; }
  [[nodiscard]] OFCondition status() const override { return EC_Normal; }
  [[nodiscard]] OFBool isFlushed() const override { return OFTrue; }
  [[nodiscard]] offile_off_t avail() const override { return offile_off_t{1} << 30; }
  offile_off_t write(const void* bytes, offile_off_t count) override {
    offile_off_t done = 0;
    while (done < count && error_ == 0) {
      const ssize_t written = ::write(descriptor_, static_cast<const char*>(bytes) + done,
                                      static_cast<std::size_t>(count - done));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) {
        error_ = errno;
      } else {
        done += written;
      }
    }
    return count;
  }
  void flush() override {}
  // The error of opening, writing or closing; 0: none.
  [[nodiscard]] int close() {
    if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0) error_ = errno;
    descriptor_ = -1;
    return error_;
  }

 private:
  int descriptor_;
  int error_ = 0;
};

class FileStream : public DcmOutputStream {
 public:
  explicit FileStream(FileConsumer& consumer) : DcmOutputStream(&consumer) {}
};

// 128 bytes, "DICM", and who sent what, which a file has and a message has not.
std::string file_head(const T_DIMSE_C_StoreRQ& request, const char* transfer_syntax) {
  DcmFileFormat format;
  DcmDataset& dataset = *format.getDataset();
  dataset.putAndInsertString(DCM_SOPClassUID, request.AffectedSOPClassUID);
  dataset.putAndInsertString(DCM_SOPInstanceUID, request.AffectedSOPInstanceUID);
  const DcmXfer syntax(transfer_syntax);
  if (format.validateMetaInfo(syntax.getXfer(), EWM_createNewMeta).bad()) return "";
  DcmMetaInfo& meta = *format.getMetaInfo();
  std::vector<char> buffer(4096);
  DcmOutputBufferStream stream(buffer.data(), static_cast<offile_off_t>(buffer.size()));
  meta.transferInit();
  const OFCondition outcome =
      meta.write(stream, META_HEADER_DEFAULT_TRANSFERSYNTAX, EET_ExplicitLength, nullptr);
  meta.transferEnd();
  void* filled = nullptr;
  offile_off_t length = 0;
  stream.flushBuffer(filled, length);
  return outcome.good() ? std::string(static_cast<const char*>(filled), static_cast<std::size_t>(length))
                        : "";
}

OFCondition answer(T_ASC_Association& association, T_ASC_PresentationContextID context,
                   const T_DIMSE_C_StoreRQ& request, unsigned status) {
  T_DIMSE_C_StoreRSP response{};
  response.MessageIDBeingRespondedTo = request.MessageID;
  response.DimseStatus = static_cast<DIC_US>(status);
  response.DataSetType = DIMSE_DATASET_NULL;
  OFStandard::strlcpy(response.AffectedSOPClassUID, request.AffectedSOPClassUID, DIC_UI_LEN + 1);
  OFStandard::strlcpy(response.AffectedSOPInstanceUID, request.AffectedSOPInstanceUID, DIC_UI_LEN + 1);
  response.opts = O_STORE_AFFECTEDSOPCLASSUID | O_STORE_AFFECTEDSOPINSTANCEUID;
  return DIMSE_sendStoreResponse(&association, context, &request, &response, nullptr);
}

OFCondition read_and_refuse(T_ASC_Association& association, Line& line, T_ASC_PresentationContextID context,
                            const T_DIMSE_C_StoreRQ& request, int timeout_s, unsigned status) {
  line.allowance.allow(kLargestRefused_bytes, "it goes on with an image that was not asked for");
  DIC_UL bytes = 0, parts = 0;
  const OFCondition outcome = DIMSE_ignoreDataSet(&association, DIMSE_NONBLOCKING, timeout_s, &bytes, &parts);
  return outcome.bad() ? outcome : answer(association, context, request, status);
}

}  // namespace

bool can_be_stored(const std::string& sop_class) { return dcmIsaStorageSOPClassUID(sop_class.c_str()); }

const std::vector<std::string>& compressed_syntaxes() {
  static const std::vector<std::string> syntaxes{
      UID_JPEGProcess14SV1TransferSyntax,     UID_JPEGProcess14TransferSyntax,
      UID_JPEGLSLosslessTransferSyntax,       UID_JPEGLSLossyTransferSyntax,
      UID_JPEG2000LosslessOnlyTransferSyntax, UID_JPEG2000TransferSyntax,
      UID_RLELosslessTransferSyntax,          UID_JPEGProcess1TransferSyntax,
      UID_JPEGProcess2_4TransferSyntax};
  return syntaxes;
}

bool can_be_kept(const std::string& transfer_syntax) {
  const auto holds = [&](const std::vector<std::string>& syntaxes) {
    return std::find(syntaxes.begin(), syntaxes.end(), transfer_syntax) != syntaxes.end();
  };
  return holds(uncompressed_syntaxes()) || holds(compressed_syntaxes());
}

OFCondition receive_image(T_ASC_Association& association, Line& line, T_ASC_PresentationContextID context,
                          const T_DIMSE_C_StoreRQ& request, int timeout_s, IncomingSeries& series) {
  if (series.is_fed_up()) return DIMSE_BADMESSAGE;
  const std::string uid = request.AffectedSOPInstanceUID, sop_class = request.AffectedSOPClassUID;
  const auto refuse = [&](unsigned status) {
    return read_and_refuse(association, line, context, request, timeout_s, status);
  };
  T_ASC_PresentationContext negotiated{};
  if (ASC_findAcceptedPresentationContext(association.params, context, &negotiated).bad() || !is_uid(uid))
    return refuse(kCannotUnderstand);
  if (sop_class != negotiated.abstractSyntax || !series.admits(uid)) return refuse(kDoesNotMatch);
  const std::string head = file_head(request, negotiated.acceptedTransferSyntax);
  if (head.empty()) return refuse(kCannotUnderstand);

  const IncomingSeries::Room room = series.room();
  line.allowance.allow(room.bytes, room.complaint);
  const fs::path temporary = series.begin(uid);
  FileConsumer consumer(temporary);
  FileStream stream(consumer);
  consumer.write(head.data(), static_cast<offile_off_t>(head.size()));
  T_ASC_PresentationContextID data_context = context;
  const OFCondition outcome = DIMSE_receiveDataSetInFile(&association, DIMSE_NONBLOCKING, timeout_s,
                                                         &data_context, &stream, nullptr, nullptr);
  if (const int error = consumer.close(); error != 0) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    if (outcome.good()) (void)answer(association, context, request, kOutOfResources);
    series.fail_to_write(error);
  }
  if (outcome.bad()) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    if (room.is_of_disk && line.allowance.is_for_good()) throw IoError(series.folder(), room.complaint);
    return outcome;
  }
  return answer(association, context, request, series.keep(temporary, uid) ? 0 : kDoesNotMatch);
}

}  // namespace arthronaut::pacs
