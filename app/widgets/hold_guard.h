// What must be held to be done: a key or a button that ends or discards something works after it was held
// down for 0.7 s. Let go before, nothing happens and the user is reminded.
//
// The time counts as it was seen: at most a quarter of a second for each frame, so that a screen that stands
// still for a second does not take a short press for a long one. The caller tells of every press and release
// of a frame before it calls advance().
#pragma once

#include <string>
#include <string_view>

namespace arthronaut::widgets {

class HoldGuard {
 public:
  static constexpr double kHold_s = 0.7;
  static constexpr double kMostOfAFrame_s = 0.25;
  static constexpr double kReminder_s = 3;

  // `what` begins to be held, whatever was held before.
  void press(std::string what);
  // Let go. What was held and is not done yet is reminded of.
  void let_go();
  // Something else came between: nothing is held, nobody is reminded.
  void cancel();
  // Reminds of `what` although it was not held.
  void remind(std::string what);
  // Once a frame. True once for each press(), when it was held for kHold_s.
  [[nodiscard]] bool advance(double now_s);

  [[nodiscard]] bool is_held() const { return is_held_; }
  // What is held, or reminded of; empty: neither.
  [[nodiscard]] const std::string& what() const { return what_; }
  // 0 to 1 while held; 0 else.
  [[nodiscard]] double progress() const;

 private:
  std::string what_;
  bool is_held_ = false;
  double last_s_ = -1;  // of the frame before; negative: none since the press
  double held_s_ = 0;
  double reminds_for_s_ = 0;
};

}  // namespace arthronaut::widgets
