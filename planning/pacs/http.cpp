#include "planning/pacs/http.h"

#include <curl/curl.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/pacs/association.h"

namespace arthronaut::pacs {

namespace {

constexpr long kLeastBytesPerSecond = 1024;
constexpr std::int64_t kLargestComplaint_bytes = 64 * 1024;

struct SlistFree {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

bool is_success(long status) { return status >= 200 && status < 300; }

bool starts_with_scheme(const std::string& url, const char* scheme) { return url.starts_with(scheme); }

}  // namespace

struct HttpClient::Curl {
  CURL* handle = curl_easy_init();
  char error[CURL_ERROR_SIZE] = {};
  ~Curl() { curl_easy_cleanup(handle); }
};

// One try, as libcurl's callbacks see it.
struct HttpClient::Transfer {
  const HttpRequest& request;
  HttpAnswer& answer;
  const std::stop_token& stop;
  CURL* handle;
  std::int64_t received = 0;
  bool is_too_long = false, cannot_keep = false;
  std::size_t part = 0, at = 0;
  std::ifstream file = {};  // of the part, where it is one

  static std::size_t write(char* data, std::size_t, std::size_t count, void* self) {
    auto& transfer = *static_cast<Transfer*>(self);
    long status = 0;
    curl_easy_getinfo(transfer.handle, CURLINFO_RESPONSE_CODE, &status);
    transfer.received += static_cast<std::int64_t>(count);
    const bool is_wanted = is_success(status);
    if (transfer.received > (is_wanted ? transfer.request.most_bytes : kLargestComplaint_bytes)) {
      transfer.is_too_long = is_wanted;
      return is_wanted ? 0 : count;  // of a complaint the rest is passed over
    }
    if (is_wanted && transfer.request.sink) {
      transfer.cannot_keep = !transfer.request.sink(data, count);
      return transfer.cannot_keep ? 0 : count;
    }
    transfer.answer.body.append(data, count);
    return count;
  }
  static std::size_t read(char* buffer, std::size_t, std::size_t room, void* self) {
    auto& transfer = *static_cast<Transfer*>(self);
    const auto& parts = transfer.request.parts;
    for (; transfer.part < parts.size(); ++transfer.part, transfer.at = 0, transfer.file.close()) {
      const HttpPart& part = parts[transfer.part];
      if (!part.file.empty()) {
        if (!transfer.file.is_open()) transfer.file.open(part.file, std::ios::binary);
        transfer.file.read(buffer, static_cast<std::streamsize>(room));
        if (!transfer.file.eof() && !transfer.file.good()) return CURL_READFUNC_ABORT;
        if (transfer.file.gcount() > 0) return static_cast<std::size_t>(transfer.file.gcount());
      } else if (transfer.at < part.text.size()) {
        const std::size_t count = std::min(room, part.text.size() - transfer.at);
        std::memcpy(buffer, part.text.data() + transfer.at, count);
        transfer.at += count;
        return count;
      }
    }
    return 0;
  }
  static int progress(void* self, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
    return static_cast<Transfer*>(self)->stop.stop_requested() ? 1 : 0;
  }
};

std::string web_password(const std::filesystem::path& file) {
  if (!file.empty()) {
    const std::string text = files::read_text(file);
    return text.substr(0, text.find_first_of("\r\n"));
  }
  const char* known = std::getenv("ARTHRONAUT_DICOMWEB_PASSWORD");
  return known != nullptr ? known : "";
}

void check(const WebServer& server) {
  const auto refuse = [&](const std::string& reason) {
    throw InvalidInput("DICOMweb server \"" + server.url + "\": " + reason);
  };
  const bool is_secure = starts_with_scheme(server.url, "https://");
  if (!is_secure && !starts_with_scheme(server.url, "http://"))
    refuse("is written https://host/path, or http://");
  const std::string rest = server.url.substr(server.url.find("://") + 3);
  const bool is_plain = std::all_of(rest.begin(), rest.end(), [](char c) { return c > ' ' && c < 0x7F; });
  if (rest.empty() || rest.front() == '/' || !is_plain || server.url.size() > 2000)
    refuse("names no host, or holds what a URL may not");
  if (rest.substr(0, rest.find('/')).find('@') != std::string::npos)
    refuse("holds a user or a password; name the user with --user, and the password in a file");
  if (rest.find_first_of("?#") != std::string::npos) refuse("holds a query or a fragment");
  if (!is_secure && !server.user.empty())
    refuse("a password does not go over http, where anybody can read it; use https");
  if (server.user.find(':') != std::string::npos) refuse("a user's name holds no colon");
  std::error_code ignored;
  if (!server.authority.empty() && !std::filesystem::is_regular_file(server.authority, ignored))
    throw InvalidInput(server.authority, "", "is not a file; it should hold the authority's certificate");
}

std::string url_encoded(const std::string& text) {
  char* encoded = curl_easy_escape(nullptr, text.data(), static_cast<int>(text.size()));
  std::string result = encoded != nullptr ? encoded : "";
  curl_free(encoded);
  return result;
}

HttpClient::HttpClient(const WebServer& server, const ConnectionOptions& options, const std::stop_token& stop)
    : server_(server), options_(options), stop_(stop) {
  pacs::check(server);
  pacs::check(options);
  static std::once_flag once;
  std::call_once(once, [] { curl_global_init(CURL_GLOBAL_DEFAULT); });
  curl_ = std::make_unique<Curl>();
  CURL* handle = curl_->handle;
  curl_easy_setopt(handle, CURLOPT_ERRORBUFFER, curl_->error);
  curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(handle, CURLOPT_PROXY, "");  // what is a patient's goes past nobody that nobody named
  curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(handle, CURLOPT_SSLVERSION, static_cast<long>(CURL_SSLVERSION_TLSv1_2));
  curl_easy_setopt(handle, CURLOPT_SSL_VERIFYPEER, 1L);
  curl_easy_setopt(handle, CURLOPT_SSL_VERIFYHOST, 2L);
  if (!server_.authority.empty()) {
    curl_easy_setopt(handle, CURLOPT_CAINFO, server_.authority.c_str());
    curl_easy_setopt(handle, CURLOPT_CAPATH, nullptr);
  }
  if (!server_.user.empty()) {
    curl_easy_setopt(handle, CURLOPT_HTTPAUTH, static_cast<long>(CURLAUTH_BASIC));
    curl_easy_setopt(handle, CURLOPT_USERNAME, server_.user.c_str());
    curl_easy_setopt(handle, CURLOPT_PASSWORD, server_.password.c_str());
  }
  curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(1000 * options_.connect_timeout_s));
  // A peer that trickles and one that is silent alike.
  curl_easy_setopt(handle, CURLOPT_LOW_SPEED_LIMIT, kLeastBytesPerSecond);
  curl_easy_setopt(handle, CURLOPT_LOW_SPEED_TIME, static_cast<long>(std::ceil(options_.answer_timeout_s)));
  curl_easy_setopt(handle, CURLOPT_USERAGENT, "arthronaut");
}

HttpClient::~HttpClient() = default;

void HttpClient::fail(const std::string& reason) const { throw DeviceError(server_.url + ": " + reason); }

HttpAnswer HttpClient::perform(const HttpRequest& request) {
  for (int attempt = 0;; ++attempt) {
    HttpAnswer answer;
    std::string reason;
    if (request.restart) request.restart();
    const bool is_answered = try_once(request, answer, reason);
    if (is_answered) return answer;  // what the server has done is told, stopped or not
    if (stop_.stop_requested()) return {.was_stopped = true};
    if (attempt >= options_.retries)
      fail(reason + (attempt == 0 ? "" : " (tried " + std::to_string(attempt + 1) + " times)"));
    pause_before_retry(options_, attempt, reason, stop_);
    if (stop_.stop_requested()) return {.was_stopped = true};
  }
}

// False: it may be tried again.
bool HttpClient::try_once(const HttpRequest& request, HttpAnswer& answer, std::string& reason) {
  CURL* handle = curl_->handle;
  Transfer transfer{.request = request, .answer = answer, .stop = stop_, .handle = handle};
  const std::string url = server_.url + request.path;
  curl_slist* lines = curl_slist_append(nullptr, ("Accept: " + request.accept).c_str());
  lines = curl_slist_append(lines, "Expect:");
  if (!request.content_type.empty())
    lines = curl_slist_append(lines, ("Content-Type: " + request.content_type).c_str());
  const std::unique_ptr<curl_slist, SlistFree> owned(lines);
  curl_off_t size = 0;
  for (const HttpPart& part : request.parts)
    size +=
        static_cast<curl_off_t>(part.file.empty() ? part.text.size() : std::filesystem::file_size(part.file));
  curl_easy_setopt(handle, CURLOPT_URL, url.c_str());
  curl_easy_setopt(handle, CURLOPT_HTTPHEADER, lines);
  if (request.parts.empty()) {
    curl_easy_setopt(handle, CURLOPT_HTTPGET, 1L);
  } else {
    curl_easy_setopt(handle, CURLOPT_POST, 1L);
    curl_easy_setopt(handle, CURLOPT_POSTFIELDSIZE_LARGE, size);
  }
  curl_easy_setopt(handle, CURLOPT_READFUNCTION, &Transfer::read);
  curl_easy_setopt(handle, CURLOPT_READDATA, &transfer);
  curl_easy_setopt(handle, CURLOPT_WRITEFUNCTION, &Transfer::write);
  curl_easy_setopt(handle, CURLOPT_WRITEDATA, &transfer);
  curl_easy_setopt(handle, CURLOPT_XFERINFOFUNCTION, &Transfer::progress);
  curl_easy_setopt(handle, CURLOPT_XFERINFODATA, &transfer);
  curl_easy_setopt(handle, CURLOPT_NOPROGRESS, 0L);
  curl_->error[0] = '\0';
  const CURLcode outcome = curl_easy_perform(handle);
  if (outcome != CURLE_OK && stop_.stop_requested()) return false;
  if (transfer.is_too_long) fail(request.complaint);
  if (transfer.cannot_keep) return true;  // who gave the sink knows why
  if (outcome != CURLE_OK) {
    reason = curl_->error[0] != '\0' ? curl_->error : curl_easy_strerror(outcome);
    if (outcome == CURLE_PEER_FAILED_VERIFICATION) fail("is not trusted: " + reason);
    if (outcome == CURLE_SSL_CACERT_BADFILE) fail("its authority's certificate cannot be used: " + reason);
    reason = outcome == CURLE_SSL_CONNECT_ERROR
                 ? "did not begin TLS: it may not speak TLS there (then its address begins with http://), or "
                   "none from 1.2 on (" +
                       reason + ")"
                 : "cannot be reached, or broke off: " + reason;
    return false;
  }
  long status = 0;
  const char *type = nullptr, *location = nullptr;
  curl_easy_getinfo(handle, CURLINFO_RESPONSE_CODE, &status);
  curl_easy_getinfo(handle, CURLINFO_CONTENT_TYPE, &type);
  curl_easy_getinfo(handle, CURLINFO_REDIRECT_URL, &location);
  answer.status = static_cast<int>(status);
  answer.content_type = type != nullptr ? type : "";
  if (status >= 300 && status < 400)
    fail("sends us elsewhere, which is not followed: " +
         std::string(location != nullptr ? location : "it does not say where").substr(0, 200));
  if (status == 401) fail("wants a user and a password, or does not know these (HTTP 401)");
  if (status == 403) fail("does not allow us that (HTTP 403)");
  reason = "answers with HTTP " + std::to_string(status);
  return status != 429 && status < 500;
}

}  // namespace arthronaut::pacs
