// Serves poses and states of an operation by OpenIGTLink (protocol version 1 messages, which every client
// reads): one TRANSFORM for each named transform and a STATUS "Arthronaut" for each state that is published.
//
// Each client has a queue and a thread of its own, so that one that reads slowly delays nobody. A client that
// takes nothing for 2 s is let go; it may come again.
#pragma once

#include <memory>

#include "navigation/operation/operation_state.h"

namespace arthronaut::openigtlink {

class IgtlServer {
 public:
  // Listens on the port on every interface; 0: any free one. Throws DeviceError when it is taken.
  explicit IgtlServer(int port);
  ~IgtlServer();
  IgtlServer(const IgtlServer&) = delete;
  IgtlServer& operator=(const IgtlServer&) = delete;

  [[nodiscard]] int port() const;
  [[nodiscard]] std::size_t client_count() const;
  // To all clients. Never waits for one; from any thread. captured_utc_s: when the picture was taken, seconds
  // since 1970, as the messages carry it.
  void publish(const operation::OperationStatePtr& state, double captured_utc_s);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::openigtlink
