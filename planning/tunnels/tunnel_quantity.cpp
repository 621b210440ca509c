#include "planning/tunnels/tunnel_quantity.h"

#include <algorithm>
#include <iterator>

namespace arthronaut::tunnels {

const Quantities& all_quantities() {
  static const Quantities all{Quantity::Entry, Quantity::Direction, Quantity::Diameter, Quantity::Length};
  return all;
}

std::string_view to_text(Quantity quantity) {
  switch (quantity) {
    case Quantity::Entry:
      return "entry";
    case Quantity::Direction:
      return "direction";
    case Quantity::Diameter:
      return "diameter";
    case Quantity::Length:
      return "length";
  }
  return "";
}

std::optional<Quantity> quantity_from_text(std::string_view text) {
  for (const Quantity quantity : all_quantities())
    if (text == to_text(quantity)) return quantity;
  return std::nullopt;
}

std::string in_words(const Quantities& quantities) {
  std::string words;
  std::size_t left = quantities.size();
  for (const Quantity quantity : quantities) {
    words += to_text(quantity);
    --left;
    words += left > 1 ? ", " : left == 1 ? " and " : "";
  }
  return words;
}

std::string known_in_words(const Quantities& known) {
  Quantities unknown;
  std::ranges::set_difference(all_quantities(), known, std::inserter(unknown, unknown.end()));
  return known.empty() || unknown.empty() ? "" : in_words(known) + "; not the " + in_words(unknown);
}

}  // namespace arthronaut::tunnels
