// HTTPS before a server that speaks HTTP, as hospitals have it: one caller at a time, on loopback.
#pragma once

#include <filesystem>
#include <string>
#include <thread>

struct ssl_ctx_st;

namespace arthronaut::test {

class TlsFront {
 public:
  // `signed_path`: without extension; .pem and .key lie there. Throws std::runtime_error.
  TlsFront(const std::filesystem::path& signed_path, int port_behind);
  ~TlsFront();
  TlsFront(const TlsFront&) = delete;
  TlsFront& operator=(const TlsFront&) = delete;
  [[nodiscard]] std::string url() const {
    return "https://127.0.0.1:" + std::to_string(port_) + "/dicom-web";
  }

 private:
  void run(const std::stop_token& stop);
  void serve(int caller, const std::stop_token& stop) const;

  const int port_, port_behind_, door_;
  ssl_ctx_st* context_;
  std::jthread thread_;
};

}  // namespace arthronaut::test
