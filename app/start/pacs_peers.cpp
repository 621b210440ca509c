#include "app/start/pacs_peers.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "app/case/case_opening.h"
#include "planning/files/json_document.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"

namespace arthronaut::start {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kPeersFormat = "arthronaut.pacs_peers";
constexpr int kPeersVersion = 2;  // with a DICOMweb server among them, else 1
constexpr std::size_t kLongestName = 60, kMostPeers = 100;

bool is_url(const std::string& address) { return address.find("://") != std::string::npos; }

PacsPeer web_peer_of(const PacsPeerForm& form) {
  PacsPeer made{.name = form.name, .peer = {}, .connection = {}};
  if (!form.certificate.empty() || !form.key.empty())
    throw InvalidInput("a DICOMweb server is shown no certificate of ours: leave certificate and key empty");
  made.web = {.url = form.address, .authority = form.authority, .user = form.user, .password = {}};
  made.web_password_file = form.key_password_file;
  pacs::check(made.web);
  return made;
}

// What a file keeps of it.
nlohmann::ordered_json web_json(const PacsPeer& peer) {
  return {{"authority", peer.web.authority.string()},
          {"user", peer.web.user},
          {"password_file", peer.web_password_file.string()}};
}

}  // namespace

std::string PacsPeer::address() const { return is_web() ? web.url : pacs::to_text(peer); }

PacsPeer peer_of(const PacsPeerForm& form) {
  if (form.name.empty() || form.name.size() > kLongestName)
    throw InvalidInput("the PACS needs a name of 1 to 60 letters, by which you know it");
  if (is_url(form.address)) return web_peer_of(form);
  if (!form.user.empty())
    throw InvalidInput("a user belongs to a DICOMweb server, whose address is https://host/path");
  PacsPeer made{.name = form.name, .peer = pacs::parse_peer(form.address), .connection = {}};
  made.connection.our_ae_title = form.our_ae_title;
  if (!form.listening_port.empty()) {
    const char* end = form.listening_port.data() + form.listening_port.size();
    const auto [at, error] = std::from_chars(form.listening_port.data(), end, made.connection.listening_port);
    if (error != std::errc() || at != end || made.connection.listening_port < 1 ||
        made.connection.listening_port > 65535)
      throw InvalidInput("our port \"" + form.listening_port +
                         "\": a number from 1 to 65535, or nothing where the PACS never calls us");
  }
  const bool speaks_tls = !form.authority.empty() || !form.certificate.empty() || !form.key.empty() ||
                          !form.key_password_file.empty() || !form.tls_name.empty();
  if (speaks_tls)
    made.connection.tls = pacs::TlsOptions{.certificate = form.certificate,
                                           .key = form.key,
                                           .authority = form.authority,
                                           .key_password_file = form.key_password_file,
                                           .name = form.tls_name};
  pacs::check(made.connection);
  return made;
}

PacsPeerForm form_of(const PacsPeer& peer) {
  const int port = peer.connection.listening_port;
  PacsPeerForm form{.name = peer.name,
                    .address = peer.address(),
                    .our_ae_title = peer.connection.our_ae_title,
                    .listening_port = port > 0 ? std::to_string(port) : "",
                    .authority = {},
                    .certificate = {},
                    .key = {},
                    .key_password_file = {},
                    .tls_name = {}};
  if (peer.is_web()) {
    form.authority = peer.web.authority.string();
    form.user = peer.web.user;
    form.key_password_file = peer.web_password_file.string();
  }
  if (!peer.connection.tls) return form;
  form.authority = peer.connection.tls->authority.string();
  form.certificate = peer.connection.tls->certificate.string();
  form.key = peer.connection.tls->key.string();
  form.key_password_file = peer.connection.tls->key_password_file.string();
  form.tls_name = peer.connection.tls->name;
  return form;
}

fs::path pacs_peers_file() { return open_case::built_in_case_folder().parent_path() / "pacs.json"; }

std::vector<PacsPeer> load_pacs_peers(const fs::path& file) {
  std::vector<PacsPeer> peers;
  if (!fs::exists(file)) return peers;
  for (const files::JsonObject& node : files::read_json(file, kPeersFormat, kPeersVersion).objects("peers")) {
    if (peers.size() == kMostPeers) node.fail("name", "there are more than 100");
    PacsPeer peer{.name = node.text("name"), .peer = {}, .connection = {}};
    const bool is_known = std::any_of(peers.begin(), peers.end(),
                                      [&](const PacsPeer& other) { return other.name == peer.name; });
    if (peer.name.empty() || is_known) node.fail("name", "must not be empty, nor another's");
    try {
      if (is_url(node.text("peer"))) {
        const files::JsonObject web = node.object("web");
        peer.web = {.url = node.text("peer"), .authority = {}, .user = web.text("user"), .password = {}};
        pacs::check(peer.web);
        peer.web.authority = web.text("authority");
        peer.web_password_file = web.text("password_file");
      } else {
        peer.peer = pacs::parse_peer(node.text("peer"));
      }
      pacs::check_ae_title(node.text("our_ae_title"));
    } catch (const InvalidInput& error) {
      node.fail("peer", error.what());
    }
    peer.connection.our_ae_title = node.text("our_ae_title");
    const std::int64_t port = node.integer("listening_port");
    if (port < 0 || port > 65535) node.fail("listening_port", "must be 0 to 65535");
    peer.connection.listening_port = static_cast<int>(port);
    // Its files are looked at when they are used: a drive may be unplugged now.
    if (node.has("tls")) {
      const files::JsonObject tls = node.object("tls");
      peer.connection.tls = pacs::TlsOptions{.certificate = tls.text("certificate"),
                                             .key = tls.text("key"),
                                             .authority = tls.text("authority"),
                                             .key_password_file = tls.text("key_password_file"),
                                             .name = tls.text("name")};
    }
    peers.push_back(std::move(peer));
  }
  return peers;
}

void save_pacs_peers(const fs::path& file, const std::vector<PacsPeer>& peers) {
  (void)load_pacs_peers(file);  // what cannot be read is somebody's and may be mended by hand
  auto nodes = nlohmann::ordered_json::array();
  for (const PacsPeer& peer : peers) {
    nlohmann::ordered_json node = {{"name", peer.name},
                                   {"peer", peer.address()},
                                   {"our_ae_title", peer.connection.our_ae_title},
                                   {"listening_port", peer.connection.listening_port}};
    if (const auto& tls = peer.connection.tls)
      node["tls"] = {{"certificate", tls->certificate.string()},
                     {"key", tls->key.string()},
                     {"authority", tls->authority.string()},
                     {"key_password_file", tls->key_password_file.string()},
                     {"name", tls->name}};
    if (peer.is_web()) node["web"] = web_json(peer);
    nodes.push_back(std::move(node));
  }
  files::create_private_folder(file.parent_path());
  const bool is_any_web =
      std::any_of(peers.begin(), peers.end(), [](const PacsPeer& peer) { return peer.is_web(); });
  files::write_json(
      file,
      {{"format", kPeersFormat}, {"version", is_any_web ? kPeersVersion : 1}, {"peers", std::move(nodes)}});
}

}  // namespace arthronaut::start
