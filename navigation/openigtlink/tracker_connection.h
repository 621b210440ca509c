// Inner header: a TCP connection that never waits for longer than it is told to.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "navigation/openigtlink/igtl_tracker.h"

namespace arthronaut::openigtlink {

class TrackerConnection {
 public:
  TrackerConnection() = default;
  ~TrackerConnection();
  TrackerConnection(const TrackerConnection&) = delete;
  TrackerConnection& operator=(const TrackerConnection&) = delete;

  // Empty: it stands. Else why not; within two seconds, or sooner when `stops` says so.
  [[nodiscard]] std::string open(const TrackerAddress& address, const std::function<bool()>& stops);
  // What is lost of it is no fault: whoever answers is heard.
  void send(std::span<const std::uint8_t> bytes);

  struct Received {
    std::size_t count = 0;  // bytes; 0: none within the time
    std::string ending;     // why no more will come; empty: more may
  };
  [[nodiscard]] Received receive(std::span<std::uint8_t> into, int wait_ms);
  // How long a message takes there and back, as the system has measured it.
  [[nodiscard]] double round_trip_s() const;

 private:
  [[nodiscard]] std::string connect_to(const void* address, std::size_t size, int family,
                                       const std::function<bool()>& stops);
  void close();

  int socket_ = -1;
};

}  // namespace arthronaut::openigtlink
