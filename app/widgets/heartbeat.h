// A mark that moves with every frame that is drawn: a screen that stands still is seen to stand still. When
// it moves again after it stood while pictures guided, it says for how long.
#pragma once

#include <string>

#include "app/widgets/controls.h"

namespace arthronaut::widgets {

class Heartbeat {
 public:
  static constexpr double kStandstill_s = 0.5;  // longer than this between two frames is told
  static constexpr double kTold_s = 10;         // for so long
  static constexpr int kPlaces = 24;            // of the mark on its circle

  // A frame is drawn. `matters`: an operation runs from now on; the time until the next frame counts.
  void beat(double now_s, bool matters);

  // Where the mark stands, 0 to kPlaces - 1; another place in every frame.
  [[nodiscard]] int place() const { return place_; }
  // How long the screen stood still last, while it was to be told; 0: it did not.
  [[nodiscard]] double stood_still_s() const { return stood_still_s_; }
  // "The screen stood still for 1.2 s"; empty when there is nothing to tell.
  [[nodiscard]] std::string words() const;

 private:
  int place_ = 0;
  double last_s_ = -1;  // negative: no frame yet
  bool matters_ = false;
  double stood_still_s_ = 0, told_until_s_ = 0;
};

// The mark in its ring, as large as the area is high.
void draw_heartbeat(const Ui& ui, const Rect& area, const Heartbeat& heartbeat);

}  // namespace arthronaut::widgets
