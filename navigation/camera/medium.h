// Refractive indices of what the arthroscope looks through.
#pragma once

#include <string>
#include <string_view>

namespace arthronaut::files {
class JsonObject;
}

namespace arthronaut::camera {

inline constexpr double kAirIndex = 1.0;
inline constexpr double kWaterIndex = 1.333;
inline constexpr double kSalineIndex = 1.3345;

// "air", "water", "saline", or a number in [1, 2]. Throws InvalidInput for anything else.
[[nodiscard]] double refractive_index_from_text(std::string_view medium);
// What a file says under `key`: such a word, or a number in [0.9, 2], as a camera takes it. Throws
// InvalidInput, which names the file and the key.
[[nodiscard]] double refractive_index_from(const files::JsonObject& json, std::string_view key);
// The word where there is one, else the number, to the last bit.
[[nodiscard]] std::string medium_to_text(double refractive_index);

}  // namespace arthronaut::camera
