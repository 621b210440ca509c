#include "tests/planning/pacs/tls_front.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <memory>
#include <stdexcept>

#include "tests/planning/pacs/orthanc.h"

namespace arthronaut::test {

namespace {

constexpr int kPoll_ms = 100;

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

bool send_all(int socket, const char* data, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = ::send(socket, data, count, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    data += sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

}  // namespace

TlsFront::TlsFront(const std::filesystem::path& signed_path, int port_behind)
    : port_(free_port()),
      port_behind_(port_behind),
      door_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)),
      context_(SSL_CTX_new(TLS_server_method())) {
  std::signal(SIGPIPE, SIG_IGN);  // OpenSSL writes to callers that have gone
  const std::string path = signed_path.string();
  const sockaddr_in address = loopback(port_);
  if (SSL_CTX_use_certificate_chain_file(context_, (path + ".pem").c_str()) != 1 ||
      SSL_CTX_use_PrivateKey_file(context_, (path + ".key").c_str(), SSL_FILETYPE_PEM) != 1 ||
      ::bind(door_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      ::listen(door_, 4) != 0)
    throw std::runtime_error("no TLS front");
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

TlsFront::~TlsFront() {
  thread_.request_stop();
  thread_.join();
  ::close(door_);
  SSL_CTX_free(context_);
}

void TlsFront::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    pollfd waiting{.fd = door_, .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, kPoll_ms) <= 0) continue;
    const int caller = ::accept(door_, nullptr, nullptr);
    serve(caller, stop);
    ::close(caller);
  }
}

void TlsFront::serve(int caller, const std::stop_token& stop) const {
  const std::unique_ptr<SSL, decltype(&SSL_free)> ssl(SSL_new(context_), &SSL_free);
  SSL_set_fd(ssl.get(), caller);
  if (SSL_accept(ssl.get()) != 1) return;
  const int behind = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(port_behind_);
  bool goes_on = ::connect(behind, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  std::array<char, 16384> buffer{};
  while (goes_on && !stop.stop_requested()) {
    std::array<pollfd, 2> waiting{pollfd{caller, POLLIN, 0}, pollfd{behind, POLLIN, 0}};
    if (SSL_pending(ssl.get()) == 0 && ::poll(waiting.data(), waiting.size(), kPoll_ms) <= 0) continue;
    if (SSL_pending(ssl.get()) > 0 || waiting[0].revents != 0) {
      const int got = SSL_read(ssl.get(), buffer.data(), static_cast<int>(buffer.size()));
      goes_on = got > 0 && send_all(behind, buffer.data(), static_cast<std::size_t>(got));
    }
    if (goes_on && waiting[1].revents != 0) {
      const ssize_t got = ::recv(behind, buffer.data(), buffer.size(), 0);
      goes_on = got > 0 && SSL_write(ssl.get(), buffer.data(), static_cast<int>(got)) > 0;
    }
  }
  ::close(behind);
}

}  // namespace arthronaut::test
