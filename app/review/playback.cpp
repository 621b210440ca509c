#include "app/review/playback.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::review {

namespace {

void play_from(Playback& playback, const recording::SessionTimeline& timeline, std::size_t frame,
               double now_s) {
  playback.frame = frame;
  playback.play_from_s = timeline.time_s(frame);
  playback.play_started_s = now_s;
}

std::size_t first_of(const Playback& playback) { return playback.loops() ? *playback.from : 0; }
std::size_t last_of(const Playback& playback, const recording::SessionTimeline& timeline) {
  return playback.loops() ? *playback.to : timeline.frames().size() - 1;
}

}  // namespace

void toggle_play(Playback& playback, const recording::SessionTimeline& timeline, double now_s) {
  playback.plays = !playback.plays;
  const bool is_at_end = playback.frame >= last_of(playback, timeline);
  const bool is_before = playback.frame < first_of(playback);
  play_from(playback, timeline, is_at_end || is_before ? first_of(playback) : playback.frame, now_s);
}

void advance(Playback& playback, const recording::SessionTimeline& timeline, double now_s) {
  if (!playback.plays) return;
  const double at_s = playback.play_from_s + (now_s - playback.play_started_s) * kSpeeds.at(playback.speed);
  const std::size_t last = last_of(playback, timeline);
  playback.frame = std::min(timeline.at_time(at_s), last);
  if (at_s < timeline.time_s(last)) return;
  if (playback.loops())
    play_from(playback, timeline, *playback.from, now_s);
  else
    playback.plays = false;
}

void go_to(Playback& playback, const recording::SessionTimeline& timeline, std::size_t frame) {
  playback.plays = false;
  playback.frame = std::min(frame, timeline.frames().size() - 1);
}

void change_speed(Playback& playback, const recording::SessionTimeline& timeline, int by, double now_s) {
  advance(playback, timeline, now_s);
  const int wanted = static_cast<int>(playback.speed) + by;
  playback.speed = static_cast<std::size_t>(std::clamp(wanted, 0, static_cast<int>(kSpeeds.size()) - 1));
  play_from(playback, timeline, playback.frame, now_s);
}

void set_loop(Playback& playback) {
  if (!playback.from) {
    playback.from = playback.frame;
  } else if (!playback.to && playback.frame != *playback.from) {
    playback.to = std::max(*playback.from, playback.frame);
    playback.from = std::min(*playback.from, playback.frame);
  } else {
    playback.from.reset();
    playback.to.reset();
  }
}

std::string speed_text(const Playback& playback) {
  const double speed = kSpeeds.at(playback.speed);
  return (speed < 1 ? "1/" + std::to_string(std::lround(1 / speed)) : std::to_string(std::lround(speed))) +
         " x";
}

}  // namespace arthronaut::review
