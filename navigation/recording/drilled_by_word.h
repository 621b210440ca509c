// Which tunnels a session says were drilled without a pose that shows where they run: the surgeon's word is
// all that there is of them, and no number.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "navigation/recording/session.h"

namespace arthronaut::recording {

struct DrilledByWord {
  std::string tunnel;             // as tunnels::name_of() names it
  std::string why;                // no pose shows it
  std::int64_t timestamp_ns = 0;  // when it was said
};

// Whether this event is one of those that the functions below read.
[[nodiscard]] bool tells_of_drilling(const SessionEvent& event);

// In the order in which it was said. Not among them: what was taken back, and what was recorded by its poses
// since. Records of before there was this event have none.
[[nodiscard]] std::vector<DrilledByWord> drilled_by_word(const std::vector<SessionEvent>& events,
                                                         bones::BoneKind bone);

// The tunnel that a file of a record keeps as drilled (operation::achieved_file_name()), as
// tunnels::name_of() names it; empty: it keeps none.
[[nodiscard]] std::string name_of_tunnel_in(const std::string& achieved_file, bones::BoneKind bone);

// The tunnels of which a session says that they are not drilled, whatever an earlier one says; as
// tunnels::name_of() names them.
[[nodiscard]] std::vector<std::string> said_too_early(const std::vector<SessionEvent>& events);

}  // namespace arthronaut::recording
