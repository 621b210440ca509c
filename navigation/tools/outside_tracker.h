// What tools.json says of an outside tracker: an optical or electromagnetic one that sees bones and tools in
// the place of the arthroscope. With it no marker is looked for in the pictures: what one eye sees of a tool
// and another of the bone has no common frame.
#pragma once

#include <map>
#include <optional>
#include <string>

namespace arthronaut::tools {

struct OutsideTracker {
  std::string address;  // "igtl://HOST:PORT"; empty: said when navigation begins
  // One sigma of each coordinate of a pose, as its maker says or somebody measured. Either empty: nobody
  // knows how wrong its poses are, and they guide nothing.
  std::optional<double> sigma_mm = std::nullopt, sigma_deg = std::nullopt;
  // "femur", "tibia" or a tool's name -> the name of its messages; others have their usual names.
  std::map<std::string, std::string> devices = {};
  // A pose that is the same to the last bit for a tenth of a second is one that the tracker lost and repeats.
  // True: of this tracker it is not; a simulated one.
  bool may_repeat = false;
  [[nodiscard]] bool has_known_error() const { return sigma_mm.has_value() && sigma_deg.has_value(); }
};

}  // namespace arthronaut::tools
