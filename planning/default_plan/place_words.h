// Where else the surgeon may enter, in words beside the place of a default tunnel. Inner header of
// default_plan.
#pragma once

#include <string>

#include "planning/default_plan/default_plan.h"
#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::default_plan {

// To be put after "at the norm's place": which way from the entry its wall is thinnest, and where within the
// norm's spread a tunnel of the same aim is better (made.other_entry), or that it is nowhere. Precondition:
// made.failed, at the norm's place, is not empty.
[[nodiscard]] std::string around_in_words(const tunnels::Tunnel& at_norm, const DefaultTunnel& made,
                                          const landmarks::AnatomicalAxes& axes, bool fails_by_diameter);

}  // namespace arthronaut::default_plan
