// When the next frame is drawn on a machine whose processor draws, too (software OpenGL): there whatever is
// drawn is taken from looking at the pictures, and a key waits for the frame that is under way. Pure.
#pragma once

#include <algorithm>

namespace arthronaut::widgets {

class DrawPace {
 public:
  // Of the time at most so much goes into frames that nobody's hand asked for; the rest is the pictures' and
  // the hand's. Frames that take longer than kInterval_s * kShare follow each other every kInterval_s all the
  // same, or as soon as they can: a screen that falls behind is no safer.
  static constexpr double kShare = 0.6, kInterval_s = 0.04;
  // While pictures are looked at too late the screen gives way to them, frame by frame down to this: a screen
  // of a third of its rate with guidance is worth more than a quick one without.
  static constexpr double kLeastShare = 0.2;

  // by_processor false: a graphics card draws, nothing waits.
  explicit DrawPace(bool by_processor) : by_processor_(by_processor) {}

  // pictures_are_late: they guide nobody, or are about to.
  void drawn(double begun_s, double shown_s, bool pictures_are_late = false) {
    if (!by_processor_) return;
    // Taken back slowly, so that the screen does not swing between too much and too little.
    constexpr double kGiven = 0.9, kTakenBack = 0.004;
    share_ = std::clamp(pictures_are_late ? share_ * kGiven : share_ + kTakenBack, kLeastShare, kShare);
    due_s_ = begun_s + std::clamp((shown_s - begun_s) / share_, 0.0, kInterval_s * kShare / share_);
  }
  // A frame for which only news ask begins no sooner; one that a hand asks for begins at once.
  [[nodiscard]] double due_s() const { return due_s_; }

 private:
  bool by_processor_;
  double share_ = kShare, due_s_ = -1e9;
};

// Whether something that moves all the time is drawn anew in this frame: where the processor draws, kRate
// times a second at most. What comes, goes or changes otherwise than by moving is never held back.
class MotionPace {
 public:
  static constexpr double kRate = 12;

  [[nodiscard]] bool is_due(double now_s, bool by_processor) {
    if (by_processor && now_s < drawn_s_ + 1 / kRate) return false;
    drawn_s_ = now_s;
    return true;
  }
  // It was drawn for another reason.
  void drawn(double now_s) { drawn_s_ = now_s; }

 private:
  double drawn_s_ = -1e9;
};

}  // namespace arthronaut::widgets
