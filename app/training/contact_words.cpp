#include "app/training/contact_words.h"

#include <algorithm>
#include <cmath>

#include "planning/files/format.h"

namespace arthronaut::training_mode {

ContactWords contact_words(const simulator::HandState& hand, bool draws, bool has_moved) {
  if (hand.touches_bone) return {widgets::Severity::Good, "On the bone"};
  const bool is_air_drawn = hand.held == simulator::Held::Probe && draws && has_moved;
  const std::string off = files::format("%.0f mm off the bone", std::max(1.0, std::round(hand.off_bone_mm)));
  return is_air_drawn ? ContactWords{widgets::Severity::Bad, "DRAWING IN THE AIR, " + off, true}
                      : ContactWords{widgets::Severity::Quiet, off};
}

}  // namespace arthronaut::training_mode
