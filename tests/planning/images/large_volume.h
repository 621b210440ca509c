// Volumes that claim to be large, or are, in small files.
#pragma once

#include <string>

#include "tests/planning/images/volume_forms.h"

namespace arthronaut::test {

inline std::string nrrd_header(const Eigen::Vector3i& size, bool gzip) {
  return "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: " +
         std::to_string(size.x()) + " " + std::to_string(size.y()) + " " + std::to_string(size.z()) +
         "\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)\nendian: little\nencoding: " +
         (gzip ? "gzip" : "raw") + "\nspace origin: (0,0,0)\n\n";
}

// Every voxel of one value; a thousandth of its size as a file.
inline std::string uniform_nrrd(const Eigen::Vector3i& size, std::int16_t value) {
  const auto count = static_cast<std::size_t>(size.cast<std::int64_t>().prod());
  std::string bytes(2 * count, '\0');
  for (std::size_t i = 0; i < count; ++i) std::memcpy(bytes.data() + 2 * i, &value, 2);
  return nrrd_header(size, true) + deflated(bytes, true);
}

}  // namespace arthronaut::test
