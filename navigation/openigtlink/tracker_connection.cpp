#include "navigation/openigtlink/tracker_connection.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

namespace arthronaut::openigtlink {

namespace {

constexpr int kConnect_ms = 2000, kGlance_ms = 50;

std::string words_of(int error) { return std::strerror(error); }

struct FreeAddresses {
  void operator()(addrinfo* p) const { freeaddrinfo(p); }
};

}  // namespace

TrackerConnection::~TrackerConnection() { close(); }

void TrackerConnection::close() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

std::string TrackerConnection::open(const TrackerAddress& to, const std::function<bool()>& stops) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int failure = getaddrinfo(to.host.c_str(), std::to_string(to.port).c_str(), &hints, &found);
  if (failure != 0) return std::string(gai_strerror(failure));
  const std::unique_ptr<addrinfo, FreeAddresses> addresses(found);
  std::string why = "no address";
  for (const addrinfo* a = addresses.get(); a != nullptr && !stops(); a = a->ai_next) {
    why = connect_to(a->ai_addr, a->ai_addrlen, a->ai_family, stops);
    if (why.empty()) return why;
  }
  return why;
}

std::string TrackerConnection::connect_to(const void* address, std::size_t size, int family,
                                          const std::function<bool()>& stops) {
  close();
  socket_ = ::socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0) return words_of(errno);
  if (::connect(socket_, static_cast<const sockaddr*>(address), static_cast<socklen_t>(size)) == 0) return "";
  if (errno != EINPROGRESS) return words_of(errno);
  for (int waited_ms = 0; waited_ms < kConnect_ms && !stops(); waited_ms += kGlance_ms) {
    pollfd wait{socket_, POLLOUT, 0};
    if (::poll(&wait, 1, kGlance_ms) <= 0) continue;
    int error = 0;
    socklen_t length = sizeof error;
    ::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &length);
    return error == 0 ? "" : words_of(error);
  }
  return "nobody answers";
}

void TrackerConnection::send(std::span<const std::uint8_t> bytes) {
  (void)::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

TrackerConnection::Received TrackerConnection::receive(std::span<std::uint8_t> into, int wait_ms) {
  pollfd wait{socket_, POLLIN, 0};
  if (::poll(&wait, 1, wait_ms) <= 0) return {};
  const ssize_t count = ::recv(socket_, into.data(), into.size(), 0);
  if (count > 0) return {static_cast<std::size_t>(count), ""};
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  return {0, count == 0 ? "the tracker has ended the connection" : words_of(errno)};
}

double TrackerConnection::round_trip_s() const {
  tcp_info info{};
  socklen_t length = sizeof info;
  if (::getsockopt(socket_, IPPROTO_TCP, TCP_INFO, &info, &length) != 0) return 0;
  return info.tcpi_rtt * 1e-6;
}

}  // namespace arthronaut::openigtlink
