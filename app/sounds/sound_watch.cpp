#include "app/sounds/sound_watch.h"

#include <utility>

namespace arthronaut::sounds {

std::optional<Sound> SoundWatch::due(Sound sound, double now_s) {
  double& last_s = last_s_[static_cast<int>(sound)];
  if (now_s - last_s < kApart_s) return std::nullopt;
  last_s = now_s;
  return sound;
}

std::optional<Sound> SoundWatch::follow(const Shown& shown, double now_s) {
  const int refusals_before = std::exchange(refusals_, shown.refusals).value_or(shown.refusals);
  const auto of_guidance = follow_guidance(shown, now_s);
  if (of_guidance || shown.refusals <= refusals_before) return of_guidance;
  return due(Sound::Refused, now_s);
}

std::optional<Sound> SoundWatch::follow_guidance(const Shown& shown, double now_s) {
  if (!shown.runs && (shown.end_was_asked || !did_guide_)) {
    before_ = {};
    guides_since_s_ = gone_since_s_ = std::nullopt;
    did_guide_ = false;
    return std::nullopt;
  }
  const Shown before = before_;
  before_ = shown;
  if (shown.guides) {
    gone_since_s_.reset();
    if (!guides_since_s_) guides_since_s_ = now_s;
    if (now_s - *guides_since_s_ >= kSettles_s) did_guide_ = true;
  } else {
    guides_since_s_.reset();
    if (!gone_since_s_) gone_since_s_ = now_s;
  }
  // Nothing else is so urgent; what comes with it is said by the screen.
  if (shown.breaks_out && !before.breaks_out) return due(Sound::Breakout, now_s);
  if (shown.doubts && !before.doubts) {
    did_guide_ = false;  // said already why it is gone
    return due(Sound::Doubtful, now_s);
  }
  if (did_guide_ && !shown.guides && now_s - *gone_since_s_ >= kSettles_s) {
    did_guide_ = false;
    return due(Sound::Lost, now_s);
  }
  if (shown.reached && !before.reached) return due(Sound::Reached, now_s);
  return std::nullopt;
}

}  // namespace arthronaut::sounds
