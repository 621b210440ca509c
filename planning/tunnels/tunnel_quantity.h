// What is measured of a drilled tunnel, each of which may be known where another is not: a rim about the bore
// hides how wide it is, not where it runs. How much bone is left beside it follows from all of them.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace arthronaut::tunnels {

enum class Quantity : std::uint8_t { Entry, Direction, Diameter, Length };
using Quantities = std::set<Quantity>;

[[nodiscard]] const Quantities& all_quantities();
[[nodiscard]] std::string_view to_text(Quantity quantity);  // "entry", "direction", "diameter", "length"
// nullopt: no such word.
[[nodiscard]] std::optional<Quantity> quantity_from_text(std::string_view text);

// "entry and direction"; "" of none.
[[nodiscard]] std::string in_words(const Quantities& quantities);
// "entry and direction; not the diameter"; "" where these are none or all.
[[nodiscard]] std::string known_in_words(const Quantities& known);

}  // namespace arthronaut::tunnels
