// Something that belongs to each tunnel that was said to be drilled (when, in which frame, by which
// registration), from a session's events in order. The word may be taken back for one tunnel of two, and then
// the other's stands.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "navigation/recording/session.h"

namespace arthronaut::recording {

template <typename T>
class OfDrilled {
 public:
  // now: what belongs to a tunnel that is drilled by this event.
  void follow(const SessionEvent& event, const T& now) {
    if (event.kind != kDrilledEvent && event.kind != kDrilledTakenBackEvent) return;
    std::erase_if(tunnels_, [&](const auto& one) { return one.first == event.text; });
    if (event.kind == kDrilledEvent) tunnels_.emplace_back(event.text, now);
  }
  // Of the tunnel that was drilled last; null: none is.
  [[nodiscard]] const T* newest() const { return tunnels_.empty() ? nullptr : &tunnels_.back().second; }

 private:
  std::vector<std::pair<std::string, T>> tunnels_;  // by the file that holds it
};

}  // namespace arthronaut::recording
