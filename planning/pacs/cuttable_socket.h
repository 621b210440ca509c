// A connection that another thread can cut, whatever DCMTK waits for on it. Inner header of pacs.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmnet/dcmlayer.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <mutex>

namespace arthronaut::pacs {

// Holds the socket by a descriptor of its own: that of DCMTK may be closed, and its number another's, by
// then.
class CuttableSocket {
 public:
  CuttableSocket() = default;
  ~CuttableSocket() { forget(); }
  CuttableSocket(const CuttableSocket&) = delete;
  CuttableSocket& operator=(const CuttableSocket&) = delete;
  void hold(int socket) {
    const std::scoped_lock lock(mutex_);
    forget();
    socket_ = ::dup(socket);
    if (is_cut_) ::shutdown(socket_, SHUT_RDWR);
  }
  // From any thread, at any time; a socket that is held later is cut at once.
  void cut() {
    const std::scoped_lock lock(mutex_);
    is_cut_ = true;
    if (socket_ >= 0) ::shutdown(socket_, SHUT_RDWR);
  }

 private:
  void forget() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }
  std::mutex mutex_;
  int socket_ = -1;
  bool is_cut_ = false;
};

// A transport layer of DCMTK's, plain or secure, that shows each socket before anything is said on it.
template <typename Layer>
class CuttableLayer : public Layer {
 public:
  template <typename... Arguments>
  explicit CuttableLayer(CuttableSocket* socket, Arguments... arguments)
      : Layer(arguments...), socket_(socket) {}
  DcmTransportConnection* createConnection(DcmNativeSocketType open_socket,
                                           OFBool use_secure_layer) override {
    // DCMTK writes a message in two parts. With Nagle's algorithm the second waits until the peer has
    // acknowledged the first, which it puts off by 40 ms: for every image.
    const int on = 1;
    (void)::setsockopt(open_socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    if (socket_ != nullptr) socket_->hold(open_socket);
    return Layer::createConnection(open_socket, use_secure_layer);
  }

 private:
  CuttableSocket* socket_;
};

}  // namespace arthronaut::pacs
