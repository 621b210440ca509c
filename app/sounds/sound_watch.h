// Which sound is due, from what the screen shows: once for each thing that happened, not for each frame in
// which it is so. Pure.
#pragma once

#include <array>
#include <optional>

#include "app/sounds/tones.h"

namespace arthronaut::sounds {

// What the screen shows now.
struct Shown {
  bool guides = false;         // numbers that may be followed
  bool doubts = false;         // what guided is in doubt, void, or an alarm stands
  bool reached = false;        // the guide stands on the plan
  bool breaks_out = false;     // a drill that is seen is about to leave the bone, or has
  bool runs = true;            // a source; without one nothing guides
  bool end_was_asked = false;  // where none runs: somebody ended it, or started another one
  int refusals = 0;            // how often something was asked for and not done, up to now
};

class SoundWatch {
 public:
  // A sound for the newest thing that has happened; what is doubtful before what is lost, since both come at
  // once; a drill that breaks out before both, and what was refused after all of them. Guidance counts as
  // lost when it was there for settles_s and then is gone for as long: a marker that flickers makes no noise.
  // A source that fails or ends by itself is followed until the loss was said; one that somebody ended is
  // forgotten at once. Of refusals those before the first call are none of its own.
  [[nodiscard]] std::optional<Sound> follow(const Shown& shown, double now_s);

  // What guided is gone, and that is not said yet: follow() has to be called soon.
  [[nodiscard]] bool waits_to_say() const { return did_guide_ && !before_.guides; }

  static constexpr double kSettles_s = 0.3;
  static constexpr double kApart_s = 1.0;  // from one sound to the same again

 private:
  [[nodiscard]] std::optional<Sound> follow_guidance(const Shown& shown, double now_s);
  [[nodiscard]] std::optional<Sound> due(Sound sound, double now_s);

  Shown before_;
  std::optional<double> guides_since_s_, gone_since_s_;
  bool did_guide_ = false;  // for long enough to be missed
  std::optional<int> refusals_;
  std::array<double, kSoundCount> last_s_{-1e9, -1e9, -1e9, -1e9, -1e9};
};

}  // namespace arthronaut::sounds
