// Certificates for the tests, made by openssl.
#pragma once

#include <filesystem>
#include <string>

#include "planning/pacs/connection.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {

// An authority with what it signs.
class Authority {
 public:
  explicit Authority(const std::string& name);
  [[nodiscard]] std::filesystem::path certificate() const { return folder_ / "authority.pem"; }
  // `made_out_to` as openssl writes it: "IP:127.0.0.1", "DNS:pacs.hospital"; negative days: expired. Returns
  // the path without extension: .pem and .key lie there.
  [[nodiscard]] std::filesystem::path sign(const std::string& name, const std::string& made_out_to,
                                           int days = 2);
  // What we show, and whom we trust.
  [[nodiscard]] pacs::TlsOptions ours();

 private:
  const TemporaryFolder folder_;
};

// Throws std::runtime_error with what it wrote.
void run_openssl(const std::string& arguments);

}  // namespace arthronaut::test
