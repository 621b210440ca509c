#include "navigation/camera/medium.h"

#include <array>
#include <charconv>
#include <sstream>
#include <utility>

#include "planning/geometry/error.h"

namespace arthronaut::camera {

namespace {
constexpr std::array<std::pair<std::string_view, double>, 3> kNamed = {
    {{"air", kAirIndex}, {"water", kWaterIndex}, {"saline", kSalineIndex}}};
}

double refractive_index_from_text(std::string_view medium) {
  for (const auto& [name, index] : kNamed) {
    if (medium == name) return index;
  }
  double index = 0;
  const auto [end, error] = std::from_chars(medium.data(), medium.data() + medium.size(), index);
  if (error != std::errc() || end != medium.data() + medium.size() || !(index >= 1 && index <= 2)) {
    throw InvalidInput("medium \"" + std::string(medium) +
                       "\": must be air, water, saline or a refractive index from 1 to 2");
  }
  return index;
}

std::string medium_to_text(double refractive_index) {
  for (const auto& [name, index] : kNamed) {
    if (refractive_index == index) return std::string(name);
  }
  std::ostringstream text;
  text << refractive_index;
  return text.str();
}

}  // namespace arthronaut::camera
