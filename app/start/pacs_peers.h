// The PACS that this user works with: a file of his own beside the recent cases, so that nobody types an
// address in theatre. It holds no password: that of an encrypted key is in a file that is named.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planning/pacs/connection.h"
#include "planning/pacs/web.h"

namespace arthronaut::start {

struct PacsPeer {
  std::string name;  // what the user calls it; unique
  pacs::Peer peer;
  // Ours with it; the other options are as they come.
  pacs::ConnectionOptions connection;
  // Where it is spoken to by DICOMweb, `web.url` is not empty and `peer` is not used. Without its password,
  // which is read from the file when it is used.
  pacs::WebServer web = {};
  std::filesystem::path web_password_file = {};

  [[nodiscard]] bool is_web() const { return !web.url.empty(); }
  [[nodiscard]] bool is_encrypted() const {
    return is_web() ? web.url.starts_with("https://") : connection.tls.has_value();
  }
  [[nodiscard]] std::string address() const;  // "PACS@pacs.hospital:104", "https://pacs.hospital/dicom-web"
};

// As it is typed; an empty port is none, TLS is spoken where one of its files is named.
struct PacsPeerForm {
  std::string name, address;  // "AET@HOST:PORT", or DICOMweb's "https://HOST/PATH"
  std::string our_ae_title = "ARTHRONAUT", listening_port;
  // Of DICOMweb the authority alone counts, the user, and the file for his password.
  std::string authority, certificate, key, key_password_file, tls_name, user = {};
};

// Throws InvalidInput with what is wrong, as a person should read it.
[[nodiscard]] PacsPeer peer_of(const PacsPeerForm& form);
[[nodiscard]] PacsPeerForm form_of(const PacsPeer& peer);

[[nodiscard]] std::filesystem::path pacs_peers_file();  // ~/.local/share/arthronaut/pacs.json

// Empty where there is no file. Throws InvalidInput or IoError for one that cannot be used, with its place.
[[nodiscard]] std::vector<PacsPeer> load_pacs_peers(const std::filesystem::path& file);
// The whole list, for its owner alone to read. A file that is there and cannot be used is not written over.
// Throws as load_pacs_peers() or IoError; the file is then as before.
void save_pacs_peers(const std::filesystem::path& file, const std::vector<PacsPeer>& peers);

}  // namespace arthronaut::start
