#include "planning/pacs/line.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>

#include "planning/files/format.h"

namespace arthronaut::pacs {

namespace {

// Slower than any line that a hospital has; faster than one byte within each time-out.
constexpr double kLeastBytesPerSecond = 1024;

class LineConnection : public DcmTransportConnection {
 public:
  LineConnection(Line& line, int socket, std::unique_ptr<DcmTransportConnection> inner)
      : DcmTransportConnection(socket), allowance_(line.allowance), inner_(std::move(inner)) {}
  OFCondition serverSideHandshake() override { return inner_->serverSideHandshake(); }
  OFCondition clientSideHandshake() override { return inner_->clientSideHandshake(); }
  OFCondition renegotiate(const char* suite) override { return inner_->renegotiate(suite); }
  ssize_t read(void* buffer, size_t count) override {
    return keep_to_allowance(count, true, [&](size_t admitted) {
      const ssize_t done = inner_->read(buffer, admitted);
      acknowledge_at_once();
      return done;
    });
  }
  ssize_t write(void* buffer, size_t count) override {
    return keep_to_allowance(count, false, [&](size_t admitted) { return inner_->write(buffer, admitted); });
  }
  void close() override { inner_->close(); }
  void closeTransportConnection() override { inner_->closeTransportConnection(); }
  unsigned long getPeerCertificateLength() override { return inner_->getPeerCertificateLength(); }
  unsigned long getPeerCertificate(void* buffer, unsigned long length) override {
    return inner_->getPeerCertificate(buffer, length);
  }
  OFBool networkDataAvailable(int timeout) override { return inner_->networkDataAvailable(timeout); }
  OFBool isTransparentConnection() override { return inner_->isTransparentConnection(); }
  OFString& dumpConnectionParameters(OFString& text) override {
    return inner_->dumpConnectionParameters(text);
  }

 private:
  // A peer writes in two parts, too (see prepare_socket), and most let the second wait for the
  // acknowledgement of the first: for every answer. The kernel goes back to putting it off, so that this is
  // asked for after every read.
  void acknowledge_at_once() {
    const int on = 1;
    (void)::setsockopt(getSocket(), IPPROTO_TCP, TCP_QUICKACK, &on, sizeof(on));
  }
  template <typename Transfer>
  ssize_t keep_to_allowance(size_t count, bool is_reading, const Transfer& transfer) {
    const std::size_t admitted = allowance_.admit(count, is_reading);
    if (admitted == 0 && count > 0) {
      errno = ECONNABORTED;
      return -1;
    }
    const ssize_t done = transfer(admitted);
    if (done > 0) allowance_.note(done, is_reading);
    return done;
  }

  Allowance& allowance_;
  std::unique_ptr<DcmTransportConnection> inner_;
};

}  // namespace

CuttableSocket::~CuttableSocket() { forget(); }

void CuttableSocket::hold(int socket) {
  const std::scoped_lock lock(mutex_);
  forget();
  socket_ = ::dup(socket);
  if (is_cut_) ::shutdown(socket_, SHUT_RDWR);
}

void CuttableSocket::cut() {
  const std::scoped_lock lock(mutex_);
  is_cut_ = true;
  if (socket_ >= 0) ::shutdown(socket_, SHUT_RDWR);
}

void CuttableSocket::forget() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

void Allowance::allow(std::int64_t bytes, std::string complaint) {
  left_ = bytes;
  too_much_ = std::move(complaint);
  begun_.reset();
  transferred_ = 0;
}

void Allowance::complain(std::string complaint, bool is_for_good) {
  if (!complaint_.empty()) return;  // the first is the cause
  complaint_ = std::move(complaint);
  is_for_good_ = is_for_good;
}

std::size_t Allowance::admit(std::size_t wanted, bool is_reading) {
  if (!complaint_.empty()) return 0;
  const Clock::time_point now = Clock::now();
  // A peer may think about what it was told before it answers: the time counts from its first byte.
  if (!begun_ || is_reading != is_reading_) {
    begun_ = now;
    is_reading_ = is_reading;
    transferred_ = 0;
  }
  const double taken_s = std::chrono::duration<double>(now - *begun_).count();
  if (taken_s > longest_silence_s_ + static_cast<double>(transferred_) / kLeastBytesPerSecond) {
    complain(files::format("it %s too slowly: %lld bytes in %.0f s", is_reading ? "speaks" : "listens",
                           static_cast<long long>(transferred_), taken_s),
             false);
    return 0;
  }
  if (!is_reading) return wanted;
  if (left_ <= 0) complain(too_much_, true);
  return static_cast<std::size_t>(std::clamp<std::int64_t>(left_, 0, static_cast<std::int64_t>(wanted)));
}

void Allowance::note(std::int64_t bytes, bool is_reading) {
  transferred_ += bytes;
  if (is_reading) left_ -= bytes;
}

CutAfter::CutAfter(Line& line, std::chrono::duration<double> time)
    : cutter_([&line, time](const std::stop_token& is_gone) {
        std::mutex mutex;
        std::condition_variable_any gone;
        std::unique_lock lock(mutex);
        (void)gone.wait_for(lock, is_gone, time, [] { return false; });
        if (!is_gone.stop_requested()) line.socket.cut();
      }) {}

DcmTransportConnection* on_line(Line& line, int socket, std::unique_ptr<DcmTransportConnection> connection) {
  return std::make_unique<LineConnection>(line, socket, std::move(connection)).release();
}

void prepare_socket(Line& line, int socket) {
  // DCMTK writes a message in two parts. With Nagle's algorithm the second waits until the peer has
  // acknowledged the first, which it puts off by 40 ms: for every image.
  const int on = 1;
  (void)::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  line.socket.hold(socket);
}

}  // namespace arthronaut::pacs
