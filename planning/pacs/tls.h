// TLS as DCMTK's network layer takes it, with every certificate checked. Inner header of pacs.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmtls/tlslayer.h>

#include <memory>
#include <string>

#include "planning/pacs/connection.h"
#include "planning/pacs/line.h"

namespace arthronaut::pacs {

class SecureLayer {
 public:
  // Loads certificates and key. `host`: what the peer's certificate must be made out to; empty (for who
  // listens): to anybody whom the authority signs. Throws InvalidInput naming the file and OpenSSL's reason;
  // nothing of a key or a password stands in it.
  SecureLayer(const TlsOptions& options, T_ASC_NetworkRole role, const std::string& host);
  ~SecureLayer();
  SecureLayer(const SecureLayer&) = delete;
  SecureLayer& operator=(const SecureLayer&) = delete;

  [[nodiscard]] LineLayer<DcmTLSTransportLayer>& layer() { return *layer_; }
  // Why the last peer was not trusted ("certificate has expired", of which subject); empty: it was.
  [[nodiscard]] std::string refusal() const;

 private:
  struct Verdict;
  std::unique_ptr<Verdict> verdict_;
  std::unique_ptr<LineLayer<DcmTLSTransportLayer>> layer_;
};

}  // namespace arthronaut::pacs
