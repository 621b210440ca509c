// One connection to a peer that need not be trusted: another thread can cut it whatever DCMTK waits for, and
// the peer can say no more on it, and no slower, than it was allowed to. Inner header of pacs.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmnet/dcmlayer.h>
#include <dcmtk/dcmnet/dcmtrans.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace arthronaut::pacs {

// Holds the socket by a descriptor of its own: that of DCMTK may be closed, and its number another's, by
// then. From any thread, at any time.
class CuttableSocket {
 public:
  CuttableSocket() = default;
  ~CuttableSocket();
  CuttableSocket(const CuttableSocket&) = delete;
  CuttableSocket& operator=(const CuttableSocket&) = delete;
  void hold(int socket);
  void cut();  // a socket that is held later is cut at once

 private:
  void forget();
  std::mutex mutex_;
  int socket_ = -1;
  bool is_cut_ = false;
};

// How much the peer may send next, and how slowly: DCMTK reads a message into memory however long it is, and
// waits anew after every byte. Used by the thread that reads and writes.
class Allowance {
 public:
  explicit Allowance(double longest_silence_s) : longest_silence_s_(longest_silence_s) {}
  // From now on, until called again. `complaint`: what is said of a peer that sends more ("it …").
  void allow(std::int64_t bytes, std::string complaint);
  // Why the connection was given up; empty: it was not. For good: the next attempt would end as this one.
  [[nodiscard]] const std::string& complaint() const { return complaint_; }
  [[nodiscard]] bool is_for_good() const { return is_for_good_; }
  void complain(std::string complaint, bool is_for_good);

  // Of the connection: how many of `wanted` bytes may be read or written now; 0: no more, for the complaint.
  [[nodiscard]] std::size_t admit(std::size_t wanted, bool is_reading);
  void note(std::int64_t bytes, bool is_reading);

 private:
  using Clock = std::chrono::steady_clock;
  const double longest_silence_s_;
  std::int64_t left_ = 0, transferred_ = 0;  // in this message and direction
  std::optional<Clock::time_point> begun_;
  bool is_reading_ = false, is_for_good_ = false;
  std::string too_much_, complaint_;
};

struct Line {
  explicit Line(double longest_silence_s) : allowance(longest_silence_s) {}
  CuttableSocket socket;
  Allowance allowance;
};

// Cuts the line unless it is gone before the time is over.
class CutAfter {
 public:
  CutAfter(Line& line, std::chrono::duration<double> time);

 private:
  std::jthread cutter_;
};

// A connection of DCMTK's, kept to the line's allowance. The line must outlive it.
[[nodiscard]] DcmTransportConnection* on_line(Line& line, int socket,
                                              std::unique_ptr<DcmTransportConnection> connection);
// Before anything is said on it.
void prepare_socket(Line& line, int socket);

// A transport layer of DCMTK's, plain or secure, whose next connection is on the line that was named last.
template <typename Layer>
class LineLayer : public Layer {
 public:
  template <typename... Arguments>
  explicit LineLayer(Arguments... arguments) : Layer(arguments...) {}
  void use(Line& line) { line_ = &line; }
  DcmTransportConnection* createConnection(DcmNativeSocketType open_socket,
                                           OFBool use_secure_layer) override {
    if (line_ == nullptr) return nullptr;
    prepare_socket(*line_, open_socket);
    std::unique_ptr<DcmTransportConnection> connection(
        Layer::createConnection(open_socket, use_secure_layer));
    return connection ? on_line(*line_, open_socket, std::move(connection)) : nullptr;
  }

 private:
  Line* line_ = nullptr;
};

}  // namespace arthronaut::pacs
