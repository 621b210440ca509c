// Inner header: what comes to a UDP port, for libavformat to read, with the ends of pictures told
// (transport_ends.h) once it is known which stream of it is wanted. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "navigation/sources/transport_ends.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace arthronaut::sources {

class DatagramInput {
 public:
  // options: those of UDP are taken out. Check error() before anything else.
  DatagramInput(const std::string& address, const AVIOInterruptCB& interrupt, AVDictionary** options);
  ~DatagramInput();
  DatagramInput(const DatagramInput&) = delete;
  DatagramInput& operator=(const DatagramInput&) = delete;

  [[nodiscard]] int error() const { return error_; }               // libav's; 0: it is open
  [[nodiscard]] AVIOContext* context() const { return context_; }  // outlives whoever reads from it
  [[nodiscard]] TransportEnds& ends() { return ends_; }

 private:
  static int read(void* self, std::uint8_t* to, int size);

  int error_ = 0;
  AVIOContext *socket_ = nullptr, *context_ = nullptr;
  TransportEnds ends_;
  std::vector<std::uint8_t> datagram_, waiting_;
  std::size_t taken_ = 0;  // of what waits
};

}  // namespace arthronaut::sources
