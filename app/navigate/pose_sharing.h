// Poses and states of the operation on the screen for other programs, by OpenIGTLink: while theatre.json
// names a port, and by nothing else. Whatever the screen hides because its picture is not of now is not sent
// as valid either.
//
// tell() may be called from the threads of several operations; the other members are the window's.
#pragma once

#include <memory>
#include <string>

#include "navigation/openigtlink/igtl_server.h"
#include "navigation/theatre/live_operation.h"

namespace arthronaut::navigate {

class PoseSharing {
 public:
  // port: -1: nothing is served; 0: any free one. A port that is taken is told by words().
  explicit PoseSharing(int port, openigtlink::Reach reach = openigtlink::Reach::ThisMachine);
  ~PoseSharing();
  PoseSharing(const PoseSharing&) = delete;
  PoseSharing& operator=(const PoseSharing&) = delete;

  // A picture that was not told of before goes out with its poses; of everything else how things stand. An
  // operation that gives no pictures says nothing while that of the other bone does.
  void tell(const theatre::LiveState& live);

  [[nodiscard]] int port() const;  // -1: nothing is served
  // "port 18944, this machine, 2 listen", or why nothing is served; empty where nobody asked for it.
  [[nodiscard]] std::string words() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::navigate
