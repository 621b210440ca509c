// Answers every connection with the bytes that the test says, on loopback.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "tests/planning/pacs/orthanc.h"

namespace arthronaut::test {

class RawWebServer {
 public:
  // `filler`: so many blanks follow the answer.
  explicit RawWebServer(std::string answer, std::size_t filler = 0)
      : RawWebServer([answer = std::move(answer)](const std::string&) { return answer; }, filler) {}
  // `answer`: to the request, of which the first line is enough for most.
  explicit RawWebServer(std::function<std::string(const std::string& request)> answer, std::size_t filler = 0)
      : answer_(std::move(answer)),
        filler_(filler),
        port_(free_port()),
        door_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    if (::bind(door_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
        ::listen(door_, 4) != 0)
      throw std::runtime_error("no port for the raw server");
    thread_ = std::jthread([this] { run(); });
  }
  ~RawWebServer() {
    ::shutdown(door_, SHUT_RDWR);
    thread_.join();
    ::close(door_);
  }
  RawWebServer(const RawWebServer&) = delete;
  RawWebServer& operator=(const RawWebServer&) = delete;
  [[nodiscard]] std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/dicom-web"; }

 private:
  void run() const {
    const std::string blanks(1 << 16, ' ');
    for (int caller = ::accept(door_, nullptr, nullptr); caller >= 0;
         caller = ::accept(door_, nullptr, nullptr)) {
      char request[4096];
      const ssize_t length = ::recv(caller, request, sizeof(request), 0);
      const std::string answer =
          length > 0 ? answer_(std::string(request, static_cast<std::size_t>(length))) : "";
      bool goes_on = length > 0 && ::send(caller, answer.data(), answer.size(), MSG_NOSIGNAL) > 0;
      for (std::size_t sent = 0; goes_on && sent < filler_; sent += blanks.size())
        goes_on = ::send(caller, blanks.data(), blanks.size(), MSG_NOSIGNAL) > 0;
      // What is closed before all that it was sent is read breaks off for the other one, answered or not.
      ::shutdown(caller, SHUT_WR);
      while (::recv(caller, request, sizeof(request), 0) > 0) {
      }
      ::close(caller);
    }
  }

  const std::function<std::string(const std::string&)> answer_;
  const std::size_t filler_;
  const int port_, door_;
  std::jthread thread_;
};

}  // namespace arthronaut::test
