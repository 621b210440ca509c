// Where on the time line the user is, whether it plays, how fast, and between which two frames it loops.
// Plain data and plain functions: the clock comes from outside.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "navigation/recording/session_timeline.h"

namespace arthronaut::review {

inline constexpr std::array<double, 7> kSpeeds{0.125, 0.25, 0.5, 1, 2, 4, 8};

struct Playback {
  std::size_t frame = 0;
  bool plays = false;
  std::size_t speed = 3;  // of kSpeeds
  // The loop's ends, both included; `to` is empty while the second one is still to be set.
  std::optional<std::size_t> from, to;
  double play_started_s = 0, play_from_s = 0;  // of the clock, of the session

  [[nodiscard]] bool loops() const { return from && to; }
};

// Preconditions of all: the timeline has frames; playback.frame is one of them.

// Starts or stops. At the end of the session or of the loop it starts from the beginning of it.
void toggle_play(Playback& playback, const recording::SessionTimeline& timeline, double now_s);
// To where it is by now. It stops at the end of the session, and goes round in a loop.
void advance(Playback& playback, const recording::SessionTimeline& timeline, double now_s);
// Stops, and shows that frame.
void go_to(Playback& playback, const recording::SessionTimeline& timeline, std::size_t frame);
// A step in kSpeeds, up or down; goes on playing from where it is.
void change_speed(Playback& playback, const recording::SessionTimeline& timeline, int by, double now_s);
// Sets the loop's one end, then its other one, then none.
void set_loop(Playback& playback);
// "1/4 x", "2 x".
[[nodiscard]] std::string speed_text(const Playback& playback);

}  // namespace arthronaut::review
