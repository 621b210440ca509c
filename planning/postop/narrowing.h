// Where a bore gets thinner for good, as beyond a socket, where a thinner bore leads the loop of a button
// out. Inner header of postop.
#pragma once

#include <optional>
#include <span>

#include "planning/postop/tunnel_fit.h"

namespace arthronaut::postop {

// So much thinner, of the radius, a bore is another one.
inline constexpr double kThinner_mm = 1;

// From the entry, by the widths of its stretches, which are equally long and in order: all that are known
// from there on are thinner than those before. Within one stretch the two widths mix as they lie in it, which
// tells to some half a millimetre. nullopt: it does not get thinner so.
[[nodiscard]] std::optional<double> narrows_at_mm(std::span<const Stretch> stretches);

}  // namespace arthronaut::postop
