// A real PACS for the tests: Orthanc (installer/debian/packages.txt), in a process, a folder and on ports of
// the test's own, gone with it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "planning/pacs/connection.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {

[[nodiscard]] int free_port();
// Whether somebody takes a connection at this port of loopback.
[[nodiscard]] bool listens(int port);

struct OrthancForm {
  std::string encoding = "Latin1";  // of its answers
  bool knows_us = true;             // as a modality, by our AE title and the port below
  bool allows_get = true;
  bool answers_anybody = true;  // who asks without being known to it
  int our_port = 0;
  // TLS where there is a certificate; it then asks for ours, too.
  std::filesystem::path certificate = {}, key = {}, authority = {};
  bool offers_web = false;  // DICOMweb, by HTTP on a port of its own
  std::string web_user = {}, web_password = {};
};

class Orthanc {
 public:
  // Throws std::runtime_error when it is not installed, or does not answer within half a minute.
  explicit Orthanc(OrthancForm form = {});
  ~Orthanc();
  Orthanc(const Orthanc&) = delete;
  Orthanc& operator=(const Orthanc&) = delete;

  [[nodiscard]] pacs::Peer peer() const { return {"ORTHANC", "127.0.0.1", port_}; }
  [[nodiscard]] std::string web_url() const {
    return "http://127.0.0.1:" + std::to_string(web_port_) + "/dicom-web";
  }
  [[nodiscard]] int web_port() const { return web_port_; }
  // At once, as by a power cut; what it had stored stays.
  void kill();
  // Again, on the same port. It ends with the thread that calls this.
  void start();

 private:
  const TemporaryFolder folder_;
  const int port_, web_port_;
  const bool offers_web_;
  pid_t process_ = -1;
};

}  // namespace arthronaut::test
