#include "app/sounds/tones.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace arthronaut::sounds {
namespace {

constexpr Sound kAll[] = {Sound::Lost, Sound::Doubtful, Sound::Reached, Sound::Breakout, Sound::Refused};

// "." for a tone below a fifth of a second, "-" for a longer one, as heard in the samples alone.
std::string heard(const std::vector<std::int16_t>& samples) {
  constexpr int kSilence = kSampleRate / 40;  // no tone of these swings so slowly
  std::string rhythm;
  int tone = 0, silence = 0;
  const auto end = [&] {
    if (tone > kSampleRate / 100) rhythm += tone < kSampleRate / 5 ? "." : "-";
    tone = 0;
  };
  for (const std::int16_t sample : samples) {
    silence = std::abs(sample) < 100 ? silence + 1 : 0;
    if (silence > kSilence)
      end();
    else
      ++tone;
  }
  end();
  return rhythm;
}

// Who hears no pitch tells them apart by their rhythm.
TEST(Tones, DifferInRhythm) {
  EXPECT_EQ(heard(samples_of(Sound::Lost)), "...");
  EXPECT_EQ(heard(samples_of(Sound::Doubtful)), "-.");
  EXPECT_EQ(heard(samples_of(Sound::Reached)), ".-");
  EXPECT_EQ(heard(samples_of(Sound::Breakout)), "--");
  EXPECT_EQ(heard(samples_of(Sound::Refused)), "-");
}

// Nothing clicks: no sample is further from the one before than the steepest of the tones is, full scale is
// never reached, and it begins and ends in silence.
TEST(Tones, DoNotClick) {
  for (const Sound sound : kAll) {
    const std::vector<std::int16_t> samples = samples_of(sound);
    ASSERT_FALSE(samples.empty());
    double highest_hz = 0;
    for (const Beat& beat : rhythm_of(sound)) highest_hz = std::max(highest_hz, beat.pitch_hz);
    // Of a third of full scale, the tone and its harmonic: (0.75 + 2 * 0.25) * amplitude * 2 pi f / rate.
    const double steepest = 1.25 * 32767 / 3 * 2 * 3.1416 * highest_hz / kSampleRate + 1;
    for (std::size_t i = 1; i < samples.size(); ++i)
      ASSERT_LE(std::abs(samples[i] - samples[i - 1]), 1.2 * steepest) << to_text(sound) << " " << i;
    EXPECT_EQ(samples.front(), 0);
    EXPECT_EQ(samples.back(), 0);
    EXPECT_LT(*std::max_element(samples.begin(), samples.end()), 16384);
  }
}

// A warning is over before the next thing can happen.
TEST(Tones, AreShort) {
  for (const Sound sound : kAll) EXPECT_LT(samples_of(sound).size(), 0.8 * kSampleRate);
}

}  // namespace
}  // namespace arthronaut::sounds
