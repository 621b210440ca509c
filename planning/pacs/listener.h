// Where a peer calls us: for the images of a C-MOVE, and with reports of storage commitment. Inner header of
// pacs.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmnet/assoc.h>
#include <dcmtk/dcmnet/dimse.h>

#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "planning/pacs/incoming_series.h"
#include "planning/pacs/tls.h"

class DcmDataset;

namespace arthronaut::pacs {

// Open from construction to destruction, on threads of its own, one a connection. Admits whoever calls our AE
// title; with TLS, whoever the authority signs.
class Listener {
 public:
  struct Handlers {
    IncomingSeries* series = nullptr;  // nullptr: images are refused
    std::function<void()> on_image;    // on a thread of the listener's
    // A report of storage commitment: its event type and contents; likewise.
    std::function<void(int event_type, DcmDataset& report)> on_commitment;
  };
  // Throws DeviceError when the port cannot be had.
  Listener(const ConnectionOptions& options, Handlers handlers);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // What went wrong while writing (disk full); empty: nothing. An IoError's text.
  [[nodiscard]] std::string failure() const;

 private:
  void accept(const std::stop_token& stop);
  void serve(T_ASC_Association& association, const std::stop_token& stop);

  const ConnectionOptions options_;
  const Handlers handlers_;
  std::unique_ptr<SecureLayer> secure_;
  std::unique_ptr<DcmTransportLayer> plain_;
  T_ASC_Network* network_ = nullptr;
  mutable std::mutex mutex_;
  std::string failure_;
  std::jthread acceptor_;
};

// Answers an N-EVENT-REPORT after its data were read, which go to `take`. Bad: the connection broke.
[[nodiscard]] OFCondition receive_commitment_report(T_ASC_Association& association,
                                                    T_ASC_PresentationContextID context,
                                                    const T_DIMSE_N_EventReportRQ& request, int timeout_s,
                                                    const std::function<void(int, DcmDataset&)>& take);

}  // namespace arthronaut::pacs
