// Which registration counts for a session, from its events in order. What stands for a tunnel is what it was
// drilled by: once the marker is out, nothing is registered any more. Of a session in which nothing is
// drilled, or by word alone, it is the newest one; that the marker was said to be out takes none away.
#pragma once

#include <string>

#include "navigation/recording/of_drilled.h"
#include "navigation/recording/session.h"

namespace arthronaut::recording {

class CountingRegistration {
 public:
  struct Trust {
    std::string file;           // in the session's folder; empty: none was recorded
    bool is_void = false;       // since it came into force
    bool was_verified = false;  // by touches, and that was not lost
  };

  void follow(const SessionEvent& event);
  [[nodiscard]] const Trust& counts() const {
    const Trust* const drilled_by = drilled_by_.newest();
    return drilled_by != nullptr ? *drilled_by : newest_;
  }
  // It is not the newest: registration.json holds another one.
  [[nodiscard]] bool is_of_before() const { return counts().file != last_file_ && !counts().file.empty(); }

 private:
  Trust newest_;
  std::string last_file_;         // of all registration events
  bool marker_goes_out_ = false;  // that was said just before
  OfDrilled<Trust> drilled_by_;
};

}  // namespace arthronaut::recording
