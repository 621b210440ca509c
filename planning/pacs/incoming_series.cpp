#include "planning/pacs/incoming_series.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "planning/files/format.h"
#include "planning/files/private_folder.h"
#include "planning/files/sha256.h"
#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"
#include "planning/pacs/connection.h"
#include "planning/pacs/dcmtk_log.h"

namespace arthronaut::pacs {

namespace fs = std::filesystem;

namespace {

constexpr const char* kTemporaryExtension = ".part";
// One image with all its frames: pixels have a length of 32 bits.
constexpr std::int64_t kLargestImage_bytes = std::int64_t{5} << 30;
constexpr double kMegabyte = 1e6;
// A peer may err, and may send again what it was not sure of. One that lists no images can be asked for the
// whole series alone, and sends all that is here already once more: that is no error of its.
constexpr int kMostRefused = 100, kMostAgain = 1000;

struct Identity {
  std::string sop_uid, series_uid, study_uid, patient_id;
};

// nullopt: not a DICOM file, or not to its end where that is asked for.
std::optional<Identity> identity_of(const fs::path& file, bool to_its_end) {
  DcmFileFormat format;
  const OFFilename name(file.c_str());
  const OFCondition outcome =
      to_its_end ? format.loadFile(name, EXS_Unknown, EGL_noChange, DCM_MaxReadLength, ERM_fileOnly)
                 : format.loadFileUntilTag(name, EXS_Unknown, EGL_noChange, DCM_MaxReadLength, ERM_fileOnly,
                                           DCM_PixelData);
  // Long values are left on the disk when a file is read: asked for, they show whether they are there.
  if (outcome.bad() || (to_its_end && format.loadAllDataIntoMemory().bad())) return std::nullopt;
  DcmDataset& dataset = *format.getDataset();
  Identity identity{.sop_uid = images::text_of(dataset, DCM_SOPInstanceUID),
                    .series_uid = images::text_of(dataset, DCM_SeriesInstanceUID),
                    .study_uid = images::text_of(dataset, DCM_StudyInstanceUID),
                    .patient_id = images::utf8_text_of(dataset, DCM_PatientID)};
  if (!is_uid(identity.sop_uid)) return std::nullopt;
  return identity;
}

fs::path without_trailing_slash(const fs::path& folder) {
  return folder.has_filename() ? folder : folder.parent_path();
}

fs::path waiting_room_of(const fs::path& folder, const std::string& series_uid) {
  constexpr std::size_t kHashLength = 12;
  return folder.parent_path() / ("." + folder.filename().string() + "-" +
                                 files::sha256_of(series_uid).substr(0, kHashLength) + ".incoming");
}

void sync_file_system_of(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) throw IoError(folder, std::string("cannot open: ") + std::strerror(errno));
  const int outcome = ::syncfs(descriptor);
  const int error = errno;
  ::close(descriptor);
  if (outcome != 0) throw IoError(folder, std::string("cannot write: ") + std::strerror(error));
}

// Empty: it is.
std::string why_not_expected(const Identity& identity, const IncomingSeries::Expected& expected) {
  if (!expected.study_uid.empty() && identity.study_uid != expected.study_uid) return "is of another study";
  if (!expected.patient_id.empty() && identity.patient_id != expected.patient_id)
    return "is of another patient";
  return "";
}

}  // namespace

IncomingSeries::IncomingSeries(fs::path folder, std::string series_uid, const Limits& limits)
    : folder_(without_trailing_slash(folder)), series_uid_(std::move(series_uid)), limits_(limits) {
  silence_dcmtk();
  waiting_room_ = waiting_room_of(folder_, series_uid_);
  check_waiting_room();
  if (fs::exists(folder_)) take_stock(folder_, false);
  create_waiting_room();
  take_stock(waiting_room_, true);
  had_count_ = static_cast<int>(files_.size());
  // Now, not after the transfer: a folder that nothing can be written into.
  const fs::path probe = begin("0");
  const int descriptor = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  const bool may_write_there =
      ::access((folder_.has_parent_path() ? folder_.parent_path() : ".").c_str(), W_OK) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  std::error_code ignored;
  fs::remove(probe, ignored);
  if (descriptor < 0 || !may_write_there) {
    leave();
    throw IoError(folder_, std::string("cannot be written to: ") + std::strerror(error));
  }
}

// In a folder that others may write to, somebody may have laid it out for us: to read along, or to have our
// files written elsewhere.
void IncomingSeries::check_waiting_room() const {
  struct stat status {};
  if (::lstat(waiting_room_.c_str(), &status) != 0) return;
  if (!S_ISDIR(status.st_mode))
    throw IoError(waiting_room_, "is where the images wait until all are there, and is no folder; remove it");
  if (status.st_uid != ::geteuid())
    throw IoError(waiting_room_,
                  "is where the images wait until all are there, and belongs to another user; use another "
                  "folder");
}

void IncomingSeries::expect(const Expected& expected) {
  const std::scoped_lock lock(mutex_);
  expected_ = expected;
  for (auto at = files_.begin(); at != files_.end();) {
    const auto identity = identity_of(at->second, false);
    const std::string reason = identity ? why_not_expected(*identity, expected_) : "cannot be read";
    if (reason.empty()) {
      ++at;
      continue;
    }
    if (at->second.parent_path() != waiting_room_)
      throw InvalidInput(at->second, "", reason + " than the peer has under this series");
    fs::remove(at->second);
    at = files_.erase(at);
  }
}

void IncomingSeries::refuse(const std::string& sop_uid, const std::string& reason) {
  ++refused_count_;
  refusal_ = "image " + sop_uid + " " + reason;
}

bool IncomingSeries::admits(const std::string& sop_uid) {
  const std::scoped_lock lock(mutex_);
  const bool is_listed = expected_.class_by_uid.empty() || expected_.class_by_uid.contains(sop_uid);
  if (!is_listed) refuse(sop_uid, "was not asked for");
  const bool is_again = files_.contains(sop_uid) && ++again_count_ > kMostAgain + had_count_;
  if (is_again) refuse(sop_uid, "is sent again and again");
  return is_listed && !is_again;
}

std::int64_t IncomingSeries::free_bytes() const {
  constexpr auto kMost = static_cast<std::uintmax_t>(std::numeric_limits<std::int64_t>::max());
  return static_cast<std::int64_t>(std::min(limits_.free_bytes(waiting_room_), kMost));
}

void IncomingSeries::fail_to_write(int error_number) const {
  throw IoError(folder_,
                files::format("cannot be written to: %s; the disk has %.0f MB free",
                              std::strerror(error_number), static_cast<double>(free_bytes()) / kMegabyte));
}

IncomingSeries::Room IncomingSeries::room() const {
  const std::int64_t free = free_bytes();
  const std::scoped_lock lock(mutex_);
  const std::int64_t of_disk = free - limits_.least_free_bytes,
                     of_series = limits_.most_bytes - received_bytes_;
  const std::string disk_words = files::format("the disk has %.0f MB free, of which %.0f MB are to stay",
                                               static_cast<double>(free) / kMegabyte,
                                               static_cast<double>(limits_.least_free_bytes) / kMegabyte);
  if (of_disk <= 0) throw IoError(folder_, disk_words);
  if (of_disk < std::min(of_series, kLargestImage_bytes))
    return {.bytes = of_disk, .is_of_disk = true, .complaint = disk_words};
  if (of_series < kLargestImage_bytes)
    return {.bytes = std::max<std::int64_t>(of_series, 0),
            .is_of_disk = false,
            .complaint = files::format("it sends more than %.0f MB for the series",
                                       static_cast<double>(limits_.most_bytes) / kMegabyte)};
  return {
      .bytes = kLargestImage_bytes, .is_of_disk = false, .complaint = "it sends more than 5 GB as one image"};
}

std::string IncomingSeries::refusal() const {
  const std::scoped_lock lock(mutex_);
  if (refused_count_ == 0) return "";
  return files::format("%d images that it sent were refused: ", refused_count_) + refusal_;
}

bool IncomingSeries::is_fed_up() const {
  const std::scoped_lock lock(mutex_);
  return refused_count_ > kMostRefused;
}

// The user knows the folder's name, not that of the one beside it.
void IncomingSeries::create_waiting_room() const {
  try {
    files::create_private_folder(waiting_room_);
  } catch (const IoError& error) {
    std::string reason = error.what();
    if (const auto at = reason.find(waiting_room_.string()); at != std::string::npos)
      reason.replace(at, waiting_room_.string().size(), folder_.string());
    throw IoError(reason);
  }
  check_waiting_room();  // who was faster than we
}

void IncomingSeries::take_stock(const fs::path& folder, bool is_ours) {
  if (!fs::is_directory(folder)) throw InvalidInput(folder, "", "is not a folder");
  std::vector<fs::path> broken;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const bool is_file = fs::is_regular_file(is_ours ? entry.symlink_status() : entry.status());
    const auto identity = is_file && entry.path().extension() != kTemporaryExtension
                              ? identity_of(entry.path(), true)
                              : std::nullopt;
    if (identity && identity->series_uid == series_uid_) {
      files_.emplace(identity->sop_uid, entry.path());
      continue;
    }
    // An image of ours that was cut off since: it is fetched anew, and stays until then.
    const bool is_cut_off =
        !identity && is_file && entry.path().extension() == ".dcm" && is_uid(entry.path().stem().string());
    if (!is_ours && is_cut_off) cut_off_.push_back(entry.path());
    if (!is_ours && !is_cut_off)
      throw InvalidInput(
          folder, "",
          "holds " + entry.path().filename().string() +
              ", which is no image of this series; name a folder that is not there yet, or empty");
    if (is_ours) broken.push_back(entry.path());
  }
  for (const fs::path& file : broken) fs::remove_all(file);
}

bool IncomingSeries::has(const std::string& sop_uid) const {
  const std::scoped_lock lock(mutex_);
  return files_.contains(sop_uid);
}

int IncomingSeries::count() const {
  const std::scoped_lock lock(mutex_);
  return static_cast<int>(files_.size());
}

std::int64_t IncomingSeries::received_bytes() const {
  const std::scoped_lock lock(mutex_);
  return received_bytes_;
}

fs::path IncomingSeries::begin(const std::string& sop_uid) {
  const std::scoped_lock lock(mutex_);
  return waiting_room_ / (sop_uid + "-" + std::to_string(begun_++) + kTemporaryExtension);
}

bool IncomingSeries::keep(const fs::path& temporary, const std::string& sop_uid) {
  const auto identity = identity_of(temporary, false);
  std::string reason;
  if (!identity) reason = "cannot be read";
  if (identity && identity->sop_uid != sop_uid) reason = "says that it is another one";
  if (identity && identity->series_uid != series_uid_) reason = "is of another series";
  {
    const std::scoped_lock lock(mutex_);
    if (reason.empty()) reason = why_not_expected(*identity, expected_);
    if (!reason.empty()) refuse(sop_uid, reason);
  }
  if (!reason.empty()) {
    fs::remove(temporary);
    return false;
  }
  const fs::path kept = waiting_room_ / (sop_uid + ".dcm");
  const auto size = static_cast<std::int64_t>(fs::file_size(temporary));
  std::error_code error;
  fs::rename(temporary, kept, error);
  if (error) throw IoError(kept, "cannot be written: " + error.message());
  const std::scoped_lock lock(mutex_);
  files_[sop_uid] = kept;
  received_bytes_ += size;
  return true;
}

void IncomingSeries::finish() {
  sync_file_system_of(waiting_room_);
  std::error_code error;
  if (!fs::exists(folder_) || fs::is_empty(folder_)) {
    fs::rename(waiting_room_, folder_, error);
    if (error) throw IoError(folder_, "cannot be created: " + error.message());
  } else {
    for (auto& [uid, file] : files_) {
      if (file.parent_path() != waiting_room_) continue;
      fs::rename(file, folder_ / file.filename(), error);
      if (error) throw IoError(folder_ / file.filename(), "cannot be written: " + error.message());
      file = folder_ / file.filename();
    }
    for (const fs::path& file : cut_off_)
      if (!files_.contains(file.stem().string())) fs::remove(file, error);
    fs::remove_all(waiting_room_, error);
  }
  sync_file_system_of(folder_.has_parent_path() ? folder_.parent_path() : ".");
}

void IncomingSeries::leave() noexcept {
  std::error_code ignored;
  if (fs::is_empty(waiting_room_, ignored) && !ignored) fs::remove(waiting_room_, ignored);
}

}  // namespace arthronaut::pacs
