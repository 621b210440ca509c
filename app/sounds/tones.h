// The five sounds of the theatre, made by arithmetic: told apart by their rhythm, so that who hears no
// pitch, or only half of it through the room, tells them apart all the same.
//
//   lost      three short, low            . . .
//   doubtful  long, short, falling        - .
//   reached   short, long, rising         . -
//   breakout  two long, high              - -
//   refused   one long, low               -
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace arthronaut::sounds {

enum class Sound { Lost, Doubtful, Reached, Breakout, Refused };
inline constexpr int kSoundCount = 5;
[[nodiscard]] std::string_view to_text(Sound sound);  // "lost", ...
// Greater: it is said before the other, as in sound_watch.h.
[[nodiscard]] int urgency_of(Sound sound);

inline constexpr int kSampleRate = 48'000;

struct Beat {
  double tone_s = 0, silence_s = 0;  // a tone, then silence
  double pitch_hz = 0;
};
[[nodiscard]] std::vector<Beat> rhythm_of(Sound sound);
// One channel of 16 bits, at a third of full scale; every tone swells and fades within 8 ms, so that nothing
// clicks.
[[nodiscard]] std::vector<std::int16_t> samples_of(Sound sound);

}  // namespace arthronaut::sounds
