// A key that was pressed and did nothing, because a case is still being opened or because what it is for is
// not possible now, and what was dropped on the window then. Said for some seconds: nothing is lost in
// silence.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/widgets/actions.h"

namespace arthronaut::window {

class UntakenKey {
 public:
  // Of every press that no action took; prefixes: of the actions in reach, as Actions::press() has them. A
  // key that is for nothing here, held on, or a way out of what is not there (Esc) needs no words.
  void note(const widgets::KeyPress& press, const widgets::Actions& actions,
            const std::vector<std::string_view>& prefixes, bool is_opening, double now_s);
  // Of what was dropped while something runs that would be cut off.
  void note_drop(double now_s);
  // Once a frame: words that hold no more go as soon as they could be read. What was pressed while a case was
  // being opened, however long that takes, is said until it is open, and then for as long that it is to be
  // pressed again.
  void look_again(const widgets::Actions& actions, bool is_opening, double now_s);
  void forget() { words_.clear(), early_key_.clear(); }  // a key was taken since
  // "N did nothing: Default plan is not possible now"; empty while there is nothing to say.
  [[nodiscard]] std::string words(double now_s) const;

 private:
  std::string words_, action_;  // the action that was not possible; empty: a case was being opened
  std::string early_key_;       // pressed while a case is being opened, and that goes on
  bool holds_ = false;
  double noted_at_s_ = 0;
};

}  // namespace arthronaut::window
