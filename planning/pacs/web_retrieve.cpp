// WADO-RS, one image a request: what came whole stays whatever breaks.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/pacs/checks.h"
#include "planning/pacs/incoming_series.h"
#include "planning/pacs/web_query.h"

namespace arthronaut::pacs {

namespace fs = std::filesystem;

namespace {

// The part's own header is a few lines; its end is the boundary.
constexpr std::size_t kLargestPartHeader_bytes = 16 * 1024;

// The one part of a multipart answer, as it comes, into a file. What precedes the part's body is cut off, and
// from the file's end the boundary.
class PartFile {
 public:
  explicit PartFile(fs::path file) : file_(std::move(file)) {}
  ~PartFile() { (void)close(); }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  void restart() {
    (void)close();
    std::error_code ignored;
    fs::remove(file_, ignored);
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    error_ = descriptor_ < 0 ? errno : 0;
    head_.clear();
    boundary_.clear();
    is_in_body_ = is_malformed_ = false;
  }
  bool take(const char* data, std::size_t count) {
    if (is_in_body_) return write(data, count);
    head_.append(data, count);
    const auto end = head_.find("\r\n\r\n");
    if (end == std::string::npos) {
      is_malformed_ = head_.size() > kLargestPartHeader_bytes;
      return !is_malformed_;
    }
    const auto begin = head_.find("--");
    const auto line_end = head_.find("\r\n", begin);
    is_malformed_ = begin == std::string::npos || line_end >= end || line_end - begin > 200;
    if (is_malformed_) return false;
    boundary_ = head_.substr(begin, line_end - begin);
    is_in_body_ = true;
    return write(head_.data() + end + 4, head_.size() - end - 4);
  }
  // Cuts the boundary off. False: there was none, so the part is not whole or there are several.
  [[nodiscard]] bool finish() {
    const off_t size = descriptor_ >= 0 ? ::lseek(descriptor_, 0, SEEK_END) : 0;
    std::string tail(
        std::min<std::size_t>(static_cast<std::size_t>(std::max<off_t>(size, 0)), boundary_.size() + 64),
        '\0');
    const off_t from = size - static_cast<off_t>(tail.size());
    const ssize_t got = descriptor_ >= 0 ? ::pread(descriptor_, tail.data(), tail.size(), from) : -1;
    const auto at =
        got == static_cast<ssize_t>(tail.size()) ? tail.find("\r\n" + boundary_ + "--") : std::string::npos;
    const bool is_whole = is_in_body_ && at != std::string::npos &&
                          ::ftruncate(descriptor_, from + static_cast<off_t>(at)) == 0;
    return close() == 0 && is_whole;
  }
  [[nodiscard]] int error() const { return error_; }  // of the disk; 0: none
  [[nodiscard]] bool is_malformed() const { return is_malformed_; }

 private:
  bool write(const char* data, std::size_t count) {
    while (count > 0 && error_ == 0) {
      const ssize_t written = ::write(descriptor_, data, count);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) {
        error_ = errno;
      } else {
        data += written;
        count -= static_cast<std::size_t>(written);
      }
    }
    return error_ == 0;
  }
  int close() {
    if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0) error_ = errno;
    descriptor_ = -1;
    return error_;
  }

  const fs::path file_;
  int descriptor_ = -1, error_ = 0;
  std::string head_, boundary_;
  bool is_in_body_ = false, is_malformed_ = false;
};

// False when stopped; throws IoError for the disk, DeviceError for the server. What is not the image that was
// asked for is refused, and told by the series.
bool fetch_image(HttpClient& client, const std::string& path, const std::string& uid,
                 IncomingSeries& series) {
  const IncomingSeries::Room room = series.room();
  const fs::path temporary = series.begin(uid);
  PartFile part(temporary);
  HttpAnswer answer;
  // An answer that is longer than it may be is the server's fault; a disk that is too full for it is not.
  constexpr std::int64_t kUnbounded = std::numeric_limits<std::int64_t>::max();
  std::int64_t received = 0;
  bool is_out_of_room = false;
  const auto remove = [&] {
    std::error_code ignored;
    fs::remove(temporary, ignored);
  };
  try {
    answer = client.perform({.path = path + "/instances/" + uid,
                             .accept = "multipart/related; type=\"application/dicom\"; transfer-syntax=*",
                             .most_bytes = room.is_of_disk ? kUnbounded : room.bytes,
                             .complaint = room.complaint,
                             .sink =
                                 [&](const char* data, std::size_t count) {
                                   received += static_cast<std::int64_t>(count);
                                   is_out_of_room = room.is_of_disk && received > room.bytes;
                                   return !is_out_of_room && part.take(data, count);
                                 },
                             .restart =
                                 [&] {
                                   received = 0;
                                   part.restart();
                                 }});
  } catch (...) {
    remove();
    throw;
  }
  const bool is_whole = part.finish();
  if (answer.was_stopped || !is_whole) remove();
  if (answer.was_stopped) return false;
  if (part.error() != 0) series.fail_to_write(part.error());
  if (is_out_of_room) throw IoError(series.folder(), room.complaint);
  if (answer.status >= 300)
    client.fail("does not give image " + uid + ": HTTP " + std::to_string(answer.status));
  if (!is_whole || part.is_malformed()) client.fail("sends image " + uid + " not whole, or not as one part");
  if (!series.keep(temporary, uid)) client.fail("sends what was not asked for: " + series.refusal());
  return true;
}

}  // namespace

RetrieveSummary retrieve_series(const WebServer& server, const ConnectionOptions& connection,
                                const RetrieveRequest& request, const OnProgress& on_progress,
                                const std::stop_token& stop) {
  check(request);
  HttpClient client(server, connection, stop);
  IncomingSeries series(request.folder, request.series_uid,
                        {request.most_bytes, request.least_free_bytes, request.free_bytes});
  RetrieveSummary summary;
  summary.kept_count = series.count();
  try {
    const SeriesImages images = ask_web_series_images(client, request.series_uid, request.study_uid);
    summary.study_uid = images.study_uid;
    if (!images.was_stopped && (!images.is_known || images.class_by_uid.empty())) {
      series.leave();
      summary.outcome = RetrieveSummary::Outcome::UnknownSeries;
      summary.message = server.url + ": has no series " + request.series_uid +
                        (request.study_uid.empty() ? "; if it should, name its study too" : " in that study");
      return summary;
    }
    if (!images.was_stopped && images.is_cut_off()) {
      series.leave();
      summary.outcome = RetrieveSummary::Outcome::Incomplete;
      summary.message = server.url + ": " + images.cut_off_words();
      return summary;
    }
    series.expect({.study_uid = images.study_uid,
                   .patient_id = images.patient_id,
                   .class_by_uid = images.class_by_uid});
    const int total = static_cast<int>(images.class_by_uid.size());
    const auto report = [&] {
      if (on_progress)
        on_progress({.done = series.count(), .total = total, .bytes = series.received_bytes()});
    };
    bool was_stopped = images.was_stopped;
    report();
    const std::string path = "/studies/" + images.study_uid + "/series/" + request.series_uid;
    for (const auto& [uid, sop_class] : images.class_by_uid) {
      if (was_stopped || stop.stop_requested()) break;
      if (series.has(uid)) continue;
      summary.way = "WADO-RS";
      was_stopped = !fetch_image(client, path, uid, series);
      if (!was_stopped) report();
    }
    summary.image_count = series.count();
    summary.received_bytes = series.received_bytes();
    if (was_stopped || stop.stop_requested()) {
      series.leave();
      summary.outcome = RetrieveSummary::Outcome::Stopped;
      summary.message = files::format(
          "stopped; %d of %d images are kept, and the same again goes on from there", series.count(), total);
      return summary;
    }
    series.finish();
    summary.outcome = RetrieveSummary::Outcome::Whole;
    summary.message =
        files::format("%d images of the series are in ", summary.image_count) + request.folder.string();
  } catch (...) {
    series.leave();
    throw;
  }
  return summary;
}

}  // namespace arthronaut::pacs
