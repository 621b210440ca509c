// The second way to a PACS: DICOMweb (PS3.18), QIDO-RS to find, WADO-RS to fetch, STOW-RS to send. The
// answers are those of query.h, retrieve.h and send.h, with the same promises.
//
// HTTPS with the certificate checked (the system's authorities, or `authority`), TLS 1.2 or newer. Plain HTTP
// is spoken where the URL says so, and never with a password. Redirects are not followed: they could lead
// anywhere.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

#include "planning/pacs/connection.h"
#include "planning/pacs/query.h"
#include "planning/pacs/retrieve.h"
#include "planning/pacs/send.h"

namespace arthronaut::pacs {

struct WebServer {
  std::string url;                  // "https://host[:port]/dicom-web", without user, query or fragment
  std::filesystem::path authority;  // PEM; empty: the system's
  std::string user, password;       // HTTP basic; empty: none
};

// The password of a server: the first line of the file, else what the environment holds in
// ARTHRONAUT_DICOMWEB_PASSWORD, else none. Throws IoError for the file.
[[nodiscard]] std::string web_password(const std::filesystem::path& file);

// Throws InvalidInput naming what is wrong.
void check(const WebServer& server);

// Of the connection's options the waits and retries count. Each throws as its namesake does: InvalidInput,
// IoError, and DeviceError with server and reason. There is no storage commitment here: what the server
// answers that it has stored, it has (PS3.18 10.5.3), and `commitment` is NotSupported.
// As a search for one study, whose answer is let go; in ms, negative when stopped.
[[nodiscard]] double echo(const WebServer& server, const ConnectionOptions& connection,
                          const std::stop_token& stop = {});
[[nodiscard]] FindSummary find(const WebServer& server, const ConnectionOptions& connection,
                               const FindKeys& keys, const FindOptions& options = {},
                               const std::stop_token& stop = {});
[[nodiscard]] RetrieveSummary retrieve_series(const WebServer& server, const ConnectionOptions& connection,
                                              const RetrieveRequest& request,
                                              const OnProgress& on_progress = {},
                                              const std::stop_token& stop = {});
[[nodiscard]] SendSummary send_files(const WebServer& server, const ConnectionOptions& connection,
                                     const std::vector<SentFile>& files, const OnProgress& on_progress = {},
                                     const std::stop_token& stop = {});

}  // namespace arthronaut::pacs
