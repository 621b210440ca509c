// Refractive indices of what the arthroscope looks through.
#pragma once

#include <string>
#include <string_view>

namespace arthronaut::camera {

inline constexpr double kAirIndex = 1.0;
inline constexpr double kWaterIndex = 1.333;
inline constexpr double kSalineIndex = 1.3345;

// "air", "water", "saline", or a number in [1, 2]. Throws InvalidInput for anything else.
[[nodiscard]] double refractive_index_from_text(std::string_view medium);
// The word where there is one, else the number.
[[nodiscard]] std::string medium_to_text(double refractive_index);

}  // namespace arthronaut::camera
