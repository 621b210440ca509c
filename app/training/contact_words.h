// What a hand feels and keys do not, said in words: whether the tip of what is held is on the bone. Pure.
#pragma once

#include <string>

#include "app/widgets/controls.h"
#include "navigation/simulator/hand_control.h"

namespace arthronaut::training_mode {

struct ContactWords {
  widgets::Severity severity = widgets::Severity::Quiet;
  std::string text;           // "On the bone", "37 mm off the bone"
  bool is_air_drawn = false;  // a stroke off the bone is being drawn
};

// draws: the operation takes strokes, and knows the tip. has_moved: a hand has moved what is held; before
// that nothing is drawn that anybody could do better.
[[nodiscard]] ContactWords contact_words(const simulator::HandState& hand, bool draws, bool has_moved);

}  // namespace arthronaut::training_mode
