// Files to a PACS (C-STORE), and its word that it keeps them (storage commitment).
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "planning/geometry/error.h"
#include "planning/pacs/connection.h"

namespace arthronaut::pacs {

enum class Commitment {
  NotAsked,      // not wanted; or it could not be asked for, which the note says
  NotSupported,  // the peer offers no storage commitment to us, or refused the request
  Awaited,       // asked for; no report came within the time, nor a refusal
  Confirmed,     // the peer keeps all that it was sent
  Failed         // it does not keep some
};
[[nodiscard]] const char* to_text(Commitment commitment);  // "confirmed", "not supported", …

struct SendOptions {
  bool asks_commitment = true;
  // How long its report is waited for: on the same connection, and on the listening port where there is one.
  double commitment_wait_s = 5;
};

struct SentFile {
  std::filesystem::path file;
  std::string sop_class_uid, sop_instance_uid;
  // What it says of itself, UTF-8: whom it names, as DICOM has it; "Model: Femur of a left knee".
  std::string patient_name = {}, patient_id = {}, birth_date = {}, title = {};
  bool is_stored = false, is_committed = false;
  std::string note;  // why not; or what the peer remarked on
};

struct SendSummary {
  enum class Outcome {
    NotRun,
    Stored,
    Stopped,
    SomeRefused,
    BrokenOff,  // some are stored; then the connection was lost, or the peer refused to go on, see failure
  } outcome = Outcome::NotRun;
  std::vector<SentFile> files;  // in the order that they were given in, each instance once
  Commitment commitment = Commitment::NotAsked;
  std::string commitment_note;  // in words; the peer's reason where it gave one
  std::string failure;          // BrokenOff: why
  [[nodiscard]] bool is_usable() const { return outcome == Outcome::Stored; }
};

// All DICOM files among `paths`, those of folders and of the folders in them by name; looked at before
// anything is sent. Throws InvalidInput for a file that is none, a folder without any, or two files that say
// they are the same instance; IoError.
[[nodiscard]] std::vector<SentFile> files_to_send(const std::vector<std::filesystem::path>& paths);

// Sends each as it is encoded; one that is not compressed may be sent in another order of bytes, which is
// without loss. What the peer has confirmed is not sent again when the connection breaks and is begun anew.
// A file that the peer refuses is told in the summary, one that is another than it was when it was looked at
// is not sent, and which are stored is told when the connection is lost for good in the middle, a file can no
// longer be read, or commitment cannot be asked for. Throws InvalidInput, and DeviceError where none was
// stored, as find().
[[nodiscard]] SendSummary send_files(const Peer& peer, const ConnectionOptions& connection,
                                     const std::vector<SentFile>& files, const SendOptions& options = {},
                                     const OnProgress& on_progress = {}, const std::stop_token& stop = {});

// Inner: whether the file still holds the object, of the patient, that somebody has read and said shall go;
// what is said of one that does not. Throws InvalidInput.
[[nodiscard]] bool is_unchanged(const SentFile& file);
inline constexpr const char* kChanged =
    "was changed since it was looked at: it is not the object that was to be sent";
// Inner: what was stored before the error is the account that is kept; the file that was on its way then is
// "not confirmed", with the error, and those after it are "not sent". False where nothing was stored: then
// the error alone says all.
[[nodiscard]] bool end_broken_off(const std::exception& error, SendSummary& summary);

}  // namespace arthronaut::pacs
