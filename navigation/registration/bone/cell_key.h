// One number for a cell of a regular grid over the bone, to look it up by: each index within a million either
// side of 0.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace arthronaut::registration {

[[nodiscard]] inline std::uint64_t cell_key(const Eigen::Vector3i& cell) {
  const auto part = [](int c) { return static_cast<std::uint64_t>(c + (1 << 20)) & 0x1fffff; };
  return part(cell.x()) | part(cell.y()) << 21 | part(cell.z()) << 42;
}

}  // namespace arthronaut::registration
