#include "planning/pacs/connection.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "planning/geometry/error.h"

namespace arthronaut::pacs {

namespace {

constexpr std::size_t kLongestTitle = 16, kLongestUid = 64, kLongestHost = 253;

[[noreturn]] void refuse_peer(std::string_view text, const std::string& reason) {
  throw InvalidInput("peer \"" + std::string(text) + "\": " + reason + "; it is written AET@HOST:PORT");
}

void check_title(const std::string& title, const std::string& what) {
  const auto is_allowed = [](char c) { return c >= ' ' && c <= '~' && c != '\\'; };
  if (title.empty() || title.size() > kLongestTitle || !std::all_of(title.begin(), title.end(), is_allowed) ||
      title.front() == ' ' || title.back() == ' ')
    throw InvalidInput(what + " \"" + title +
                       "\": an AE title has 1 to 16 printable ASCII characters, no backslash");
}

void check_seconds(double value, const char* name) {
  if (!(value >= 1 && value <= 3600))
    throw InvalidInput(std::string(name) + ": must be between 1 and 3600 seconds");
}

void check_file(const std::filesystem::path& file, const char* what) {
  if (file.empty()) throw InvalidInput(std::string("TLS needs ") + what);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw InvalidInput(file, "", std::string("is not a file; it should hold ") + what);
}

}  // namespace

Peer parse_peer(std::string_view text) {
  const auto at = text.find('@');
  const auto colon = text.rfind(':');
  if (at == std::string_view::npos) refuse_peer(text, "has no AE title");
  if (colon == std::string_view::npos || colon < at) refuse_peer(text, "has no port");
  Peer peer{.ae_title = std::string(text.substr(0, at)),
            .host = std::string(text.substr(at + 1, colon - at - 1)),
            .port = 0};
  const std::string_view port = text.substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), peer.port);
  if (error != std::errc() || end != port.data() + port.size() || peer.port < 1 || peer.port > 65535)
    refuse_peer(text, "the port is not a number from 1 to 65535");
  if (peer.host.find(':') != std::string::npos || peer.host.starts_with('['))
    refuse_peer(text, peer.host +
                          " is an IPv6 address, which this version's DICOM network (DCMTK 3.6.7) does not "
                          "speak; give its name or IPv4 address");
  const auto is_of_host = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' ||
           c == '-' || c == '_';
  };
  if (peer.host.empty() || peer.host.size() > kLongestHost ||
      !std::all_of(peer.host.begin(), peer.host.end(), is_of_host))
    refuse_peer(text, "the host is neither a name nor an IPv4 address");
  check_title(peer.ae_title, "peer \"" + std::string(text) + "\": AE title");
  return peer;
}

std::string to_text(const Peer& peer) {
  return peer.ae_title + "@" + peer.host + ":" + std::to_string(peer.port);
}

void check_ae_title(const std::string& title) { check_title(title, "our AE title"); }

bool is_uid(std::string_view text) {
  return !text.empty() && text.size() <= kLongestUid && text.front() != '.' && text.back() != '.' &&
         text.find("..") == std::string_view::npos &&
         std::all_of(text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
}

void check(const ConnectionOptions& options) {
  check_ae_title(options.our_ae_title);
  check_seconds(options.connect_timeout_s, "connect_timeout_s");
  check_seconds(options.answer_timeout_s, "answer_timeout_s");
  if (options.retries < 0 || options.retries > 100) throw InvalidInput("retries: must be between 0 and 100");
  if (!(options.first_pause_s >= 0 && options.first_pause_s <= 60))
    throw InvalidInput("first_pause_s: must be between 0 and 60 seconds");
  if (options.listening_port < 0 || options.listening_port > 65535)
    throw InvalidInput("listening_port: must be between 1 and 65535, or 0 for none");
  if (!options.tls) return;
  check_file(options.tls->certificate, "our certificate");
  check_file(options.tls->key, "our private key");
  check_file(options.tls->authority, "the certificate of who signs the peer's");
  if (!options.tls->key_password_file.empty())
    check_file(options.tls->key_password_file, "the key's password");
}

}  // namespace arthronaut::pacs
