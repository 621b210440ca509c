// Serves an operation by OpenIGTLink (protocol version 1 messages, which every client reads). For each state
// that is published: one TRANSFORM for each named transform and a STATUS "Arthronaut" with the reason why
// nothing guides; a STATUS of a transform's name when there is none any more, and why, and again when there
// is, since a client goes on showing what came last; POINT "Plan" to each client when it comes and whenever
// the plan is another one; IMAGE "Arthroscope" to those who ask for it (GET_IMAGE: one; STT_IMAGE until
// STP_IMAGE: as they come).
//
// To a client that has sent anything of version 2 or later transforms go out as version 2, with
// "TransformStatus" in their metadata: OK, and INVALID once when there is none any more.
//
// Each client has a queue and a thread of its own, so that one that reads slowly delays nobody. A client that
// takes nothing for 2 s, or is ten seconds behind, is let go; it may come again. Of pictures at most one
// waits for a client.
#pragma once

#include <memory>

#include "navigation/camera/frame.h"
#include "navigation/openigtlink/named_transforms.h"
#include "navigation/operation/operation_state.h"

namespace arthronaut::openigtlink {

// Who may listen. Poses, plan and pictures of a patient go out without a password: to programs of this
// machine, and to others only where somebody said so.
enum class Reach { ThisMachine, Network };

class IgtlServer {
 public:
  // 0: any free port. Throws DeviceError when it is taken.
  explicit IgtlServer(int port, Reach reach = Reach::ThisMachine);
  ~IgtlServer();
  IgtlServer(const IgtlServer&) = delete;
  IgtlServer& operator=(const IgtlServer&) = delete;

  [[nodiscard]] int port() const;
  [[nodiscard]] std::size_t client_count() const;
  // To all clients. Never waits for one; from any thread. captured_utc_s: when the picture was taken, seconds
  // since 1970, as the messages carry it. picture: of that state, null when there is none.
  void publish(const operation::OperationStatePtr& state, double captured_utc_s,
               const camera::FramePtr& picture = nullptr);
  // Without poses, while there is no picture that could be published, or between two. still: whose poses,
  // published before, hold; null: none does.
  void tell(const Status& status, double utc_s, const operation::OperationStatePtr& still = nullptr);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::openigtlink
