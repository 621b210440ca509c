// A peer that does not keep to DICOM's rules, on loopback and in this process.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmnet/assoc.h>
#include <dcmtk/dcmnet/dimse.h>

#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include "planning/pacs/connection.h"

namespace arthronaut::test {

// Takes every association and context, and hands each request with its data to what the test wants of it.
class HostilePeer {
 public:
  struct Request {
    T_ASC_Association& association;
    T_ASC_PresentationContextID context;
    T_DIMSE_Message& message;
    DcmDataset& data;  // empty where there are none
  };
  // False: the connection is ended.
  using Habit = std::function<bool(Request&)>;
  explicit HostilePeer(Habit habit);
  ~HostilePeer();
  HostilePeer(const HostilePeer&) = delete;
  HostilePeer& operator=(const HostilePeer&) = delete;

  [[nodiscard]] pacs::Peer peer() const { return {"HOSTILE", "127.0.0.1", port_}; }

 private:
  void run(const std::stop_token& stop);
  void serve(T_ASC_Association& association, const std::stop_token& stop);

  const Habit habit_;
  const int port_;
  T_ASC_Network* network_ = nullptr;
  std::jthread thread_;
};

// An answer to a C-FIND; false when it could not be sent.
bool answer_find(const HostilePeer::Request& request, DcmDataset* answer, unsigned status);
// The file to the peer, as part of a C-GET; the status that it is answered with, 0xFFFF when it could not be
// sent.
unsigned store(const HostilePeer::Request& request, DcmDataset& image);
// Says that it has stored the file of a C-STORE; false when that could not be sent.
bool take_file(const HostilePeer::Request& request);
// An N-EVENT-REPORT of storage commitment; false when it could not be sent.
bool report_commitment(const HostilePeer::Request& request, DcmDataset& data);
void end_get(const HostilePeer::Request& request, int failed);

}  // namespace arthronaut::test
