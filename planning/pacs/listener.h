// Where a peer calls us: for the images of a C-MOVE, and with reports of storage commitment. Inner header of
// pacs.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmnet/assoc.h>
#include <dcmtk/dcmnet/dimse.h>

#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "planning/pacs/incoming_series.h"
#include "planning/pacs/line.h"
#include "planning/pacs/tls.h"

class DcmDataset;

namespace arthronaut::pacs {

// Open from construction to destruction, on threads of its own, one a connection, 16 of them at once at most.
// Admits whoever calls our AE title; with TLS, whoever the authority signs. One caller at a time may
// introduce itself, within 5 s or the connection's time-out, so that one who says nothing holds up the others
// no longer than that.
class Listener {
 public:
  struct Handlers {
    IncomingSeries* series = nullptr;        // nullptr: images are refused
    std::set<std::string> sop_classes = {};  // of its images; empty: any that can be stored
    std::function<void()> on_image;          // on a thread of the listener's
    std::int64_t largest_report_bytes = 0;
    // A report of storage commitment: its event type and contents; likewise.
    std::function<void(int event_type, DcmDataset& report)> on_commitment = {};
  };
  // Throws DeviceError when the port cannot be had.
  Listener(const ConnectionOptions& options, Handlers handlers);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // What went wrong while writing (disk full); empty: nothing. An IoError's text.
  [[nodiscard]] std::string failure() const;
  // Why a caller was cut off ("it sends …"), the last one; empty: none was.
  [[nodiscard]] std::string complaint() const;
  // That are served now; who has gone is not among them.
  [[nodiscard]] int connection_count() const;

 private:
  struct Connection;
  void accept(const std::stop_token& stop);
  [[nodiscard]] std::unique_ptr<Connection> next_connection(std::size_t count);
  void serve(Connection& connection, const std::stop_token& stop);
  [[nodiscard]] OFCondition answer(Connection& connection, T_DIMSE_Message& message,
                                   T_ASC_PresentationContextID context);

  const ConnectionOptions options_;
  const Handlers handlers_;
  std::unique_ptr<SecureLayer> secure_;
  std::unique_ptr<LineLayer<DcmTransportLayer>> plain_;
  T_ASC_Network* network_ = nullptr;
  mutable std::mutex mutex_;
  std::string failure_, complaint_;
  int connection_count_ = 0;
  std::jthread acceptor_;
};

// Answers an N-EVENT-REPORT after its data were read, which go to `take`. Bad: the connection broke, or the
// report is larger than that.
[[nodiscard]] OFCondition receive_commitment_report(T_ASC_Association& association, Line& line,
                                                    std::int64_t largest_bytes,
                                                    T_ASC_PresentationContextID context,
                                                    const T_DIMSE_N_EventReportRQ& request, int timeout_s,
                                                    const std::function<void(int, DcmDataset&)>& take);

}  // namespace arthronaut::pacs
