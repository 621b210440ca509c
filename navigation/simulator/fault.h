// What goes wrong in a simulated scene that somebody's hand moves: which fault, when it comes, how long it
// lasts, and what it does to the pictures.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "navigation/camera/frame.h"

namespace arthronaut::simulator {

enum class FaultKind { Bleeding, Glare, BumpedMarker, LostSource, FoggedLens, SlippedBoard };
[[nodiscard]] std::string_view to_text(FaultKind kind);

struct Fault {
  enum class Trigger {
    AtTime,      // `after` in s
    ProbeDrawn,  // once the tip has slid over `after` mm of bone
    GuideNear,   // once the guide's point is within `after` mm of the planned entry
  };
  FaultKind kind = FaultKind::Bleeding;
  Trigger trigger = Trigger::AtTime;
  double after = 0;
  // Of a bumped marker and a slipped board without meaning: they stay where they were pushed.
  double duration_s = 5;
  // Bleeding, glare and fog: 0 to 1. A bumped marker: mm that it shifts along the bone, with 1.5 degrees a
  // mm. A slipped board: degrees that it tips.
  double strength = 0.5;
};

// The faults of one run as they come.
class FaultPlay {
 public:
  FaultPlay(std::vector<Fault> faults, std::uint64_t seed);
  // Goes on to time_s. is_due is asked of each that waits for something else than the time; begins is told of
  // each that begins. Returned: 1 << FaultKind of those that act, and of a push once it has happened.
  [[nodiscard]] unsigned advance(double time_s, const std::function<bool(const Fault&)>& is_due,
                                 const std::function<void(const Fault&)>& begins);
  // What acts now, laid over the picture. Bleeding and fog grow and fade within 1.5 s.
  void spoil(camera::Frame& frame, std::uint64_t noise_seed) const;

 private:
  struct One {
    Fault fault;
    std::optional<double> began_s;
  };
  [[nodiscard]] bool acts(const One& one) const;

  std::vector<One> faults_;
  std::uint64_t seed_;
  double time_s_ = 0;
};

}  // namespace arthronaut::simulator
