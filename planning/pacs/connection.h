// Who is spoken to on a DICOM network, who we are there, and how long is waited.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace arthronaut::pacs {

struct Peer {
  std::string ae_title;  // 1 to 16 characters (PS3.5, AE), without blanks around
  std::string host;      // a name or an IPv4 address
  int port = 0;          // 1 to 65535
};

// "AET@HOST:PORT". Throws InvalidInput, which says what is wrong with it.
[[nodiscard]] Peer parse_peer(std::string_view text);
[[nodiscard]] std::string to_text(const Peer& peer);
// Throws InvalidInput unless it is 1 to 16 printable ASCII characters other than the backslash, not all
// blank.
void check_ae_title(const std::string& title);
// Digits and dots, 1 to 64 of them (PS3.5, UI): what may stand in a file's name too.
[[nodiscard]] bool is_uid(std::string_view text);

// TLS by the profile of BCP 195: TLS 1.2 or newer. The peer's certificate must be signed by `authority`, be
// valid today, and be made out to the host that was asked for, or to `name` where that is given. All files
// PEM.
struct TlsOptions {
  std::filesystem::path certificate, key;   // ours, which the peer checks
  std::filesystem::path authority;          // who signs the peer's
  std::filesystem::path key_password_file;  // its first line; empty: the key is not encrypted
  std::string name;                         // empty: the peer's host
};

// A connection that did not come about, or broke, before it is tried again.
struct Retry {
  std::string reason;
  int number = 1;      // of the tries without progress, from 1
  double pause_s = 0;  // until then
};

struct ConnectionOptions {
  std::string our_ae_title = "ARTHRONAUT";
  std::optional<TlsOptions> tls;  // nullopt: in the clear
  double connect_timeout_s = 10;  // for TCP, and again for the negotiation
  double answer_timeout_s = 60;   // without a byte from the peer
  // How often a connection that did not come about, or broke, is tried again; the pause before the first is
  // this long, and doubles up to 15 s. What the peer refuses for good is not tried again.
  int retries = 3;
  double first_pause_s = 0.5;
  // Where we listen while a peer sends on a connection of its own (C-MOVE, reports of storage commitment); 0:
  // nowhere. The peer must know our AE title with this host and port.
  int listening_port = 0;
  // Called before each of these pauses, on the thread that works; may be empty.
  std::function<void(const Retry& retry)> on_retry = {};
};

// Throws InvalidInput naming the option and its limits, or the file that is missing.
void check(const ConnectionOptions& options);

struct TransferProgress {
  int done = 0, total = 0;  // images or files; total 0: not known yet
  std::int64_t bytes = 0;   // received or sent, this time
};
// Called on the thread that transfers.
using OnProgress = std::function<void(const TransferProgress&)>;

}  // namespace arthronaut::pacs
