// What comes between lens and bone, painted over the luma of a finished picture by seed and time: what must
// not be taken for a bone that was knocked. Coarse on purpose: it is to cover and to change, not to please.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>
#include <vector>

namespace arthronaut::contour_clips {

enum class Obstruction { None, Blood, Glare, Tool, Debris, Smear, DimLight };
inline constexpr int kObstructionKinds = 7;
[[nodiscard]] std::string_view to_text(Obstruction kind);

// It comes for 4 of every 8 seconds, at its strongest in the middle of them.
void obstruct(Obstruction kind, std::uint64_t seed, double time_s, const Eigen::Vector2i& size_px,
              const std::vector<std::uint8_t>& luma, std::vector<std::uint8_t>& obstructed);

}  // namespace arthronaut::contour_clips
