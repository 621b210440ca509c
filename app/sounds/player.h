// Plays the theatre's sounds on a thread of its own. Whoever asks for one never waits; where there is no
// sound device that is said, and nothing else comes of it.
#pragma once

#include <memory>
#include <string>

#include "app/sounds/tones.h"

namespace arthronaut::sounds {

class Player {
 public:
  // ALSA's name of the device: "default" is what the desktop plays on. It is tried once at the beginning, and
  // opened anew for every sound: one that is plugged in later is heard.
  explicit Player(const std::string& device = "default");
  ~Player();  // ends a sound that is being played
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  // From any thread. Nothing while muted; of several that wait the most urgent is played, of those the
  // newest.
  void play(Sound sound);
  void mute(bool on);
  [[nodiscard]] bool is_muted() const;
  // Why nothing can be heard, for who stands before the screen ("no loudspeaker is connected"); empty while
  // it can, or is not known yet. What the system calls it is in the log.
  [[nodiscard]] std::string trouble() const;
  // Waits until what was asked for is played; for tests.
  void finish() const;

 private:
  struct Thread;
  std::unique_ptr<Thread> thread_;
};

}  // namespace arthronaut::sounds
