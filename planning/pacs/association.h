// One association with a peer, asked for again while it does not come about. Inner header of pacs.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmnet/assoc.h>
#include <dcmtk/dcmnet/dimse.h>

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "planning/pacs/connection.h"
#include "planning/pacs/line.h"
#include "planning/pacs/tls.h"

namespace arthronaut::pacs {

// One presentation context: the peer picks one of the transfer syntaxes.
struct Proposal {
  std::string sop_class;
  std::vector<std::string> transfer_syntaxes;
  bool we_are_provider = false;  // the peer may store with us (C-GET)
};

// An association has no more contexts than this (their ids are odd and one byte).
inline constexpr std::size_t kMostProposals = 128;

// A command has some 20 short values.
inline constexpr std::int64_t kLargestCommand_bytes = 64 * 1024;
inline constexpr const char* kTooLargeCommand = "it sends a command of more than 64 kB";
// The list of what a peer could not send, and the like: not read, and not without end either.
inline constexpr std::int64_t kLargestRemark_bytes = 16 * 1024 * 1024;

[[nodiscard]] const std::vector<std::string>& uncompressed_syntaxes();

// Owns the connection: aborts it unless it was released. Used by one thread. A stop that is requested while
// it lives cuts the connection, so that whatever waits for the peer ends with an error.
class Association {
 public:
  // Throws InvalidInput for what the options hold, and DeviceError that names the peer and the reason: not
  // reachable after all retries, not trusted, refused. nullptr when stopped.
  [[nodiscard]] static std::unique_ptr<Association> connect(const Peer& peer,
                                                            const ConnectionOptions& options,
                                                            const std::vector<Proposal>& proposals,
                                                            const std::stop_token& stop);
  ~Association();
  Association(const Association&) = delete;
  Association& operator=(const Association&) = delete;

  void release();
  [[nodiscard]] T_ASC_Association& get() { return *association_; }
  // 0: the peer takes no such context. The second asks for that very transfer syntax.
  [[nodiscard]] T_ASC_PresentationContextID accepted(const std::string& sop_class) const;
  [[nodiscard]] T_ASC_PresentationContextID accepted(const std::string& sop_class,
                                                     const std::string& transfer_syntax) const;
  [[nodiscard]] DIC_US next_message_id() { return ++last_message_id_; }
  [[nodiscard]] int answer_timeout_s() const { return answer_timeout_s_; }
  [[nodiscard]] Line& line() { return line_; }
  // What the peer may send until the next call of this: a message without data, or with some.
  void expect_command() { line_.allowance.allow(kLargestCommand_bytes, kTooLargeCommand); }
  // Why an operation failed: what the line complains of, else what DCMTK says.
  [[nodiscard]] std::string why(const OFCondition& outcome) const;
  [[nodiscard]] bool is_given_up_for_good() const { return line_.allowance.is_for_good(); }

 private:
  explicit Association(const ConnectionOptions& options) : line_(options.answer_timeout_s) {}
  void abort();
  [[nodiscard]] OFCondition request(const Peer& peer, const ConnectionOptions& options,
                                    const std::vector<Proposal>& proposals);

  Line line_;
  std::unique_ptr<SecureLayer> secure_;
  std::unique_ptr<LineLayer<DcmTransportLayer>> plain_;
  T_ASC_Network* network_ = nullptr;
  T_ASC_Association* association_ = nullptr;
  bool is_established_ = false;
  DIC_US last_message_id_ = 0;
  int answer_timeout_s_ = 0;
  std::optional<std::stop_callback<std::function<void()>>> cut_when_stopped_;
};

// Tells of it and waits, or less when stopped: the pause before try number `attempt`, from 0.
void pause_before_retry(const ConnectionOptions& options, int attempt, const std::string& reason,
                        const std::stop_token& stop);

// What the peer said of why, beside a status: its error comment; empty when it said nothing. Frees it.
[[nodiscard]] std::string take_comment(DcmDataset*& status_detail);
// "0xA701 (out of resources): comment".
[[nodiscard]] std::string status_text(unsigned status, const std::string& comment);
inline constexpr std::string_view kPeerEnded = "the peer ended the connection";
// Readable reason of what DCMTK's network layer returns.
[[nodiscard]] std::string reason_of(const OFCondition& condition);

}  // namespace arthronaut::pacs
