#include "app/sounds/tones.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::sounds {

int urgency_of(Sound sound) {
  switch (sound) {
    case Sound::Breakout:
      return 4;
    case Sound::Doubtful:
      return 3;
    case Sound::Lost:
      return 2;
    case Sound::Reached:
      return 1;
    case Sound::Refused:
      return 0;
  }
  return 0;
}

std::string_view to_text(Sound sound) {
  switch (sound) {
    case Sound::Lost:
      return "lost";
    case Sound::Doubtful:
      return "doubtful";
    case Sound::Reached:
      return "reached";
    case Sound::Breakout:
      return "breakout";
    case Sound::Refused:
      return "refused";
  }
  return "";
}

std::vector<Beat> rhythm_of(Sound sound) {
  switch (sound) {
    case Sound::Lost:
      return {{0.09, 0.09, 330}, {0.09, 0.09, 330}, {0.09, 0.05, 330}};
    case Sound::Doubtful:
      return {{0.36, 0.10, 494}, {0.10, 0.05, 392}};
    case Sound::Reached:
      return {{0.10, 0.07, 659}, {0.36, 0.05, 880}};
    case Sound::Breakout:
      return {{0.26, 0.08, 988}, {0.26, 0.05, 988}};
    case Sound::Refused:
      return {{0.36, 0.05, 294}};
  }
  return {};
}

std::vector<std::int16_t> samples_of(Sound sound) {
  constexpr double kLoudness = 32767.0 / 3, kSwell_s = 0.008, kPi = 3.14159265358979323846;
  std::vector<std::int16_t> samples;
  for (const Beat& beat : rhythm_of(sound)) {
    const auto tone = static_cast<int>(beat.tone_s * kSampleRate);
    for (int i = 0; i < tone; ++i) {
      const double t = static_cast<double>(i) / kSampleRate;
      const double swell = std::min({1.0, t / kSwell_s, (beat.tone_s - t) / kSwell_s});
      // A second harmonic carries better through a small loudspeaker than the tone alone.
      const double phase = 2 * kPi * beat.pitch_hz * t;
      const double wave = 0.75 * std::sin(phase) + 0.25 * std::sin(2 * phase);
      samples.push_back(static_cast<std::int16_t>(std::lround(kLoudness * std::max(0.0, swell) * wave)));
    }
    samples.insert(samples.end(), static_cast<std::size_t>(beat.silence_s * kSampleRate), std::int16_t{0});
  }
  return samples;
}

}  // namespace arthronaut::sounds
