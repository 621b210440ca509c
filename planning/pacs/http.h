// HTTP to one server, by libcurl: bounded answers, no redirects, time-outs, retries. Inner header of pacs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "planning/pacs/web.h"

namespace arthronaut::pacs {

struct HttpAnswer {
  bool was_stopped = false;
  int status = 0;  // 200, 204, 404, …
  std::string content_type = {}, body = {};
};

// Of what is posted: a text, or what a file holds, which is read as it goes out.
struct HttpPart {
  std::string text = {};
  std::filesystem::path file = {};
};

struct HttpRequest {
  std::string path;    // after the server's URL, with its query, all of it encoded
  std::string accept;  // a media type
  std::int64_t most_bytes = 0;
  std::string complaint;  // what is said of a longer answer ("it …")
  // Takes the body of a 2xx as it comes, instead of `body`; false: it cannot be kept. Begun anew by
  // `restart`.
  std::function<bool(const char*, std::size_t)> sink = {};
  std::function<void()> restart = {};
  // To be posted: read in turn.
  std::string content_type = {};
  std::vector<HttpPart> parts = {};
};

// One connection, kept open between requests. One thread.
class HttpClient {
 public:
  HttpClient(const WebServer& server, const ConnectionOptions& options, const std::stop_token& stop);
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  // Tried again while the connection fails, and for 5xx and 429. Throws DeviceError, with the server and the
  // reason, for what does not get better: TLS, a redirect, 401 and 403, an answer that is too long.
  [[nodiscard]] HttpAnswer perform(const HttpRequest& request);
  // "https://host/dicom-web: " + reason.
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  struct Transfer;
  [[nodiscard]] bool try_once(const HttpRequest& request, HttpAnswer& answer, std::string& reason);

  struct Curl;
  const WebServer server_;
  const ConnectionOptions options_;
  const std::stop_token stop_;
  std::unique_ptr<Curl> curl_;
};

// Of a value in a URL.
[[nodiscard]] std::string url_encoded(const std::string& text);

}  // namespace arthronaut::pacs
