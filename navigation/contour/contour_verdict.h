// What the registered bone against the picture comes to (contour_check.h): data for screen and record.
#pragma once

#include <cstdint>
#include <string_view>

namespace arthronaut::contour {

enum class ContourState {
  NotChecked,
  Holds,    // enough is seen, and no displacement up to 1.75 mm fits better
  Drifted,  // it does not, or it was found again up to 8 mm off; stays until begin()
  // What is seen is not what was seen there, as after a hard knock, and it was not found again: until it
  // looks as it did for a second, or begin().
  LooksOtherwise,
};
[[nodiscard]] std::string_view to_text(ContourState state);

// Why it is NotChecked. TooLittleInView: of what looks as it did.
enum class NotCheckedReason { NoRegistration, NoPose, Settling, TooLittleInView };
[[nodiscard]] std::string_view to_text(NotCheckedReason reason);

struct ContourVerdict {
  std::int64_t timestamp_ns = 0;
  ContourState state = ContourState::NotChecked;
  NotCheckedReason reason = NotCheckedReason::NoRegistration;
  double share_seen = 0;                       // of directions in which a drift by 1 mm would be told
  int outline_pieces = 0, surface_pieces = 0;  // that this frame was asked about
  // With Drifted, as it was told: by which of the two, and about how far, of what can be seen of it.
  bool is_by_outline = false;
  double drift_mm = 0;
  // Until then at the latest the bone was seen to lie where it lay; what it has done since, nobody knows.
  // Meaningful from begin() on.
  std::int64_t held_until_ns = 0;
};

}  // namespace arthronaut::contour
