// Where a bore gets thinner for good, as beyond a socket, where a thinner bore leads the loop of a button
// out. Inner header of postop.
#pragma once

#include <optional>
#include <span>

#include "planning/postop/tunnel_fit.h"

namespace arthronaut::postop {

// So much thinner, of the radius, a bore is another one: the thinnest socket is 6 mm wide, and the bore
// beyond it 4.5.
inline constexpr double kThinner_mm = 0.5;

struct Narrowing {
  double from_entry_mm = 0;
  double thinner_mm = 0;  // the least width beyond
};
// By the widths of a bore's stretches, which are equally long and in order: all that are known
// from there on are thinner than those before, and it gets thinner all at once, not by and by as what widened
// does. Within one stretch the two widths mix as they lie in it, which tells to a millimetre or two. nullopt:
// it does not get thinner so.
[[nodiscard]] std::optional<Narrowing> narrowing_of(std::span<const Stretch> stretches);

}  // namespace arthronaut::postop
