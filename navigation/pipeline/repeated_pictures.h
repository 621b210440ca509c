// Whether pictures repeat the one before, how much of that is their source's habit, and when it is more: the
// source may hang, and what it shows is not to be guided by.
//
// A converter repeats by habit; what a hanging source does beyond that is seen two pictures later. What is
// shown on for 95 ms is too old whatever the habit. A codec does not repeat a picture that hangs at once: it
// refines it for a few pictures, and codes it anew as a key frame now and then. What tells then is the stop:
// everything that moved moves no more from one picture to the next, and hardly anything of the source's noise
// is left. No hand stops so, and a live picture that is at rest keeps its noise. Nor does one stop and go on
// by as much again and again: what lies between are repeats, however an encoder refines them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace arthronaut::pipeline {

// Of one source's pictures in order of time; deterministic, allocates nothing.
class RepeatedPictures {
 public:
  // A first picture, which repeats none.
  void begin(std::int64_t timestamp_ns);
  // The next one. largest: how much the tile changed that changed most since the picture before, mean
  // difference in grey values; noise: of the source, likewise; below 0: not known. True: it repeats.
  bool observe(double largest, double noise, std::int64_t timestamp_ns);

  // How much a picture may differ that repeats the one before.
  [[nodiscard]] static double most_repeat(double noise);
  // For 55 ms and more pictures repeat beyond the source's habit, or the picture stopped; until something
  // moves, or until it is noisy again for 95 ms, and for 0.3 s where it hardly changes: a key frame of the
  // same picture and what follows are not.
  [[nodiscard]] bool is_suspected() const { return is_suspected_; }
  // What the newest picture shows may be an encoder's refinement: nothing of the source's noise is in it.
  [[nodiscard]] bool may_be_refined() const { return is_suspected_ || stop_.stands(); }
  // For how long the newest picture has shown what it shows: since the first one that it repeats, or since
  // everything stopped, for as long as nothing says whether the picture hangs or is at rest. What is shown is
  // as old as that, so that a picture that hangs is too old before the one comes that makes it suspected.
  // 0: it shows something new, or is suspected.
  [[nodiscard]] std::int64_t shown_for_ns() const { return shown_for_ns_; }
  // Of the pictures after since_ns: what repeats, and what an encoder made of repeats between two that move.
  [[nodiscard]] double share(std::int64_t since_ns) const;
  // The same of what repeats, and while it is suspected of what hardly changed since everything stopped: as
  // much of it as the picture that hangs.
  [[nodiscard]] double hanging_share(std::int64_t since_ns) const;
  [[nodiscard]] bool has_begun() const { return count_ > 0; }
  void reset() { *this = RepeatedPictures(); }

 private:
  static constexpr std::size_t kMost = 128;
  struct Step {
    std::int64_t timestamp_ns = 0;
    bool repeats = false, is_coded_repeat = false, is_in_stop = false;
  };
  struct Row {
    int count = 0;  // of repeats
    std::int64_t since_ns = 0;
  };
  // Since everything stood still from one picture to the next.
  struct Stop {
    Row repeats;
    int others = 0;
    int lively = 0;         // of the others, those that change as much as noise does
    int lively_in_row = 0;  // up to the newest one
    double moved = 0;       // as much as a tile did before; 0: there was no stop
    // Key frames are others, one picture in a dozen.
    [[nodiscard]] bool stands() const { return moved > 0 && others <= 1 + repeats.count / 10; }
    [[nodiscard]] bool is_of_repeats() const { return stands() && repeats.count >= 2; }
  };
  template <typename Which>
  [[nodiscard]] double share_of(std::int64_t since_ns, const Which& which) const;
  [[nodiscard]] int habit() const;
  [[nodiscard]] bool is_too_long(const Row& row, std::int64_t timestamp_ns) const;
  void follow_stop(double largest, double noise);
  [[nodiscard]] bool hardly_changes(double largest, double noise) const;
  [[nodiscard]] bool is_refined(double largest, double noise) const;

  std::array<Step, kMost> steps_{};  // a ring of the newest
  std::size_t count_ = 0;
  Row row_;
  Stop stop_;
  std::array<double, 4> largest_{};  // of the pictures before, the newest first; since a stop from it on
  std::int64_t last_ns_ = 0, shown_for_ns_ = 0;
  bool is_suspected_ = false;
  bool stops_and_goes_ = false;      // the picture that moved last ended a stop
  std::int64_t lives_since_ns_ = 0;  // while it is suspected: the last picture that repeats
};

}  // namespace arthronaut::pipeline
