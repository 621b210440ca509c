// STOW-RS, one object a request: what the server has confirmed is not sent again.
#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "planning/files/sha256.h"
#include "planning/geometry/error.h"
#include "planning/pacs/association.h"
#include "planning/pacs/http.h"
#include "planning/pacs/web_query.h"

namespace arthronaut::pacs {

namespace {

using nlohmann::json;

constexpr std::int64_t kLargestAnswer_bytes = 1024 * 1024;

// The instances that a sequence of the answer names, each with its reason where there is one.
bool names(const json& answer, const char* sequence, const std::string& uid, int& reason) {
  if (!answer.is_object() || !answer.contains(sequence) || !answer[sequence].is_object() ||
      !answer[sequence].contains("Value") || !answer[sequence]["Value"].is_array())
    return false;
  for (const json& item : answer[sequence]["Value"]) {
    if (!item.is_object()) continue;
    if (web_text(item, "00081155") != uid) continue;
    const std::string code = web_text(item, "00081197");
    reason = 0;
    std::from_chars(code.data(), code.data() + code.size(), reason);
    return true;
  }
  return false;
}

// False when stopped.
bool send_one(HttpClient& client, SentFile& file) {
  if (!is_unchanged(file)) {
    file.note = kChanged;
    return true;
  }
  const std::string boundary = "arthronaut-" + files::sha256_of(file.sop_instance_uid);
  const HttpAnswer answer =
      client.perform({.path = "/studies",
                      .accept = "application/dicom+json",
                      .most_bytes = kLargestAnswer_bytes,
                      .complaint = "answers what it was sent with more than 1 MB",
                      .content_type = "multipart/related; type=\"application/dicom\"; boundary=" + boundary,
                      .parts = {{.text = "--" + boundary + "\r\nContent-Type: application/dicom\r\n\r\n"},
                                {.file = file.file},
                                {.text = "\r\n--" + boundary + "--\r\n"}}});
  if (answer.was_stopped) return false;
  const json said = json::parse(answer.body, nullptr, false);
  int reason = 0;
  if (names(said, "00081198", file.sop_instance_uid, reason)) {
    file.note = "refused with " + status_text(static_cast<unsigned>(reason), "");
    return true;
  }
  file.is_stored =
      answer.status >= 200 && answer.status < 300 && names(said, "00081199", file.sop_instance_uid, reason);
  if (!file.is_stored)
    file.note = "not stored: the server answers with HTTP " + std::to_string(answer.status) +
                (answer.status < 300 ? ", and does not name it among what it has stored" : "");
  return true;
}

}  // namespace

SendSummary send_files(const WebServer& server, const ConnectionOptions& connection,
                       const std::vector<SentFile>& files, const OnProgress& on_progress,
                       const std::stop_token& stop) {
  HttpClient client(server, connection, stop);
  SendSummary summary;
  summary.files = files;
  summary.commitment = Commitment::NotSupported;
  summary.commitment_note = "DICOMweb has no storage commitment; what the server says it has stored, it has";
  std::int64_t bytes = 0;
  int done = 0;
  for (SentFile& file : summary.files) {
    try {
      if (stop.stop_requested() || !send_one(client, file)) {
        summary.outcome = SendSummary::Outcome::Stopped;
        return summary;
      }
    } catch (const std::runtime_error& error) {
      if (!end_broken_off(error, summary)) throw;
      return summary;
    }
    std::error_code ignored;
    bytes += static_cast<std::int64_t>(std::filesystem::file_size(file.file, ignored));
    if (on_progress)
      on_progress({.done = ++done, .total = static_cast<int>(summary.files.size()), .bytes = bytes});
  }
  const bool is_all = std::all_of(summary.files.begin(), summary.files.end(),
                                  [](const SentFile& file) { return file.is_stored; });
  summary.outcome = is_all ? SendSummary::Outcome::Stored : SendSummary::Outcome::SomeRefused;
  return summary;
}

}  // namespace arthronaut::pacs
