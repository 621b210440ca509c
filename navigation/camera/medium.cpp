#include "navigation/camera/medium.h"

#include <array>
#include <charconv>
#include <utility>

#include "planning/files/json_document.h"
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

double refractive_index_from(const files::JsonObject& json, std::string_view key) {
  if (json.is_number(key)) {
    const double index = json.number(key);
    if (!(index >= 0.9 && index <= 2)) json.fail(key, "a refractive index must lie in [0.9, 2]");
    return index;
  }
  try {
    return refractive_index_from_text(json.text(key));
  } catch (const InvalidInput&) {
    json.fail(key, "must be air, water, saline or a refractive index");
  }
}

std::string medium_to_text(double refractive_index) {
  for (const auto& [name, index] : kNamed) {
    if (refractive_index == index) return std::string(name);
  }
  // As short as it can be and still be read back as the same number: files hold it, and compare it.
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), refractive_index);
  return {text.data(), end};
}

}  // namespace arthronaut::camera
