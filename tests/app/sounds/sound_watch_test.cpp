#include "app/sounds/sound_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace arthronaut::sounds {
namespace {

// Follows frames of a thirtieth of a second and keeps what was heard.
class Listener {
 public:
  void see(const Shown& shown, double seconds) {
    for (int i = 0; i < std::max(1, static_cast<int>(seconds * 30)); ++i) {
      now_s_ += 1.0 / 30;
      if (const auto sound = watch_.follow(shown, now_s_)) heard.push_back(*sound);
    }
  }
  std::vector<Sound> heard;

 private:
  SoundWatch watch_;
  double now_s_ = 100;
};

const Shown kNothing{}, kGuides{.guides = true}, kReached{.guides = true, .reached = true},
    kDoubt{.doubts = true};
using Heard = std::vector<Sound>;

TEST(SoundWatch, LossIsHeardOnce) {
  Listener listener;
  listener.see(kNothing, 3);  // nothing was there to be lost
  EXPECT_EQ(listener.heard, Heard{});
  listener.see(kGuides, 2);
  listener.see(kNothing, 5);
  EXPECT_EQ(listener.heard, Heard{Sound::Lost});
  listener.see(kGuides, 2);
  listener.see(kNothing, 2);
  EXPECT_EQ(listener.heard, (Heard{Sound::Lost, Sound::Lost}));
}

// Hazard 3: a source that fails while it guides is a loss like any other; one that somebody ended is none.
TEST(SoundWatch, Hazard3AnEndNobodyAskedForIsHeard) {
  const Shown failed{.runs = false}, ended{.runs = false, .end_was_asked = true};
  Listener listener;
  listener.see(kGuides, 2);
  listener.see(failed, 5);
  EXPECT_EQ(listener.heard, Heard{Sound::Lost});
  listener.see(kGuides, 2);
  listener.see(ended, 5);
  EXPECT_EQ(listener.heard, Heard{Sound::Lost});
}

// A marker that flickers makes no noise.
TEST(SoundWatch, FlickerIsNotHeard) {
  Listener listener;
  for (int i = 0; i < 30; ++i) {
    listener.see(kGuides, 0.5);
    listener.see(kNothing, 0.1);
  }
  EXPECT_EQ(listener.heard, Heard{});
}

// Doubt is said at once, in place of the loss that it brings.
TEST(SoundWatch, DoubtComesBeforeLoss) {
  Listener listener;
  listener.see(kGuides, 2);
  listener.see(kDoubt, 3);
  EXPECT_EQ(listener.heard, Heard{Sound::Doubtful});
}

TEST(SoundWatch, ReachedIsHeardWhenItComes) {
  Listener listener;
  listener.see(kGuides, 1);
  listener.see(kReached, 3);
  EXPECT_EQ(listener.heard, Heard{Sound::Reached});
  listener.see(kGuides, 1);
  listener.see(kReached, 1);
  EXPECT_EQ(listener.heard, (Heard{Sound::Reached, Sound::Reached}));
}

// Heard the moment it is so, whether the guide is seen or not, and once while it stays so.
TEST(SoundWatch, Hazard7ADrillThatBreaksOutIsHeard) {
  const Shown breaks_out{.breaks_out = true};
  Listener listener;
  listener.see(kNothing, 1);
  listener.see(breaks_out, 3);
  EXPECT_EQ(listener.heard, Heard{Sound::Breakout});
  listener.see(kNothing, 2);
  listener.see(breaks_out, 1);
  EXPECT_EQ(listener.heard, (Heard{Sound::Breakout, Sound::Breakout}));
}

// What trembles about its limit is not a machine gun.
TEST(SoundWatch, TheSameSoundKeepsApart) {
  Listener listener;
  listener.see(kGuides, 1);
  for (int i = 0; i < 15; ++i) {
    listener.see(kReached, 0.04);
    listener.see(kGuides, 0.04);
  }
  EXPECT_LE(listener.heard.size(), 2u);
  EXPECT_GE(listener.heard.size(), 1u);
}

// Every press that was for nothing is heard, also where no source runs; none from before it was listened to,
// and a drill that breaks out first.
TEST(SoundWatch, WhatIsRefusedIsHeardEachTime) {
  Listener listener;
  listener.see({.refusals = 3}, 1);
  EXPECT_EQ(listener.heard, Heard{});
  listener.see({.refusals = 4}, 2);
  listener.see({.runs = false, .end_was_asked = true, .refusals = 5}, 2);
  EXPECT_EQ(listener.heard, (Heard{Sound::Refused, Sound::Refused}));
  listener.see({.runs = false, .end_was_asked = true, .refusals = 5}, 2);
  listener.see({.breaks_out = true, .refusals = 6}, 1);
  EXPECT_EQ(listener.heard, (Heard{Sound::Refused, Sound::Refused, Sound::Breakout}));
}

}  // namespace
}  // namespace arthronaut::sounds
