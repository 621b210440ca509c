#include "planning/images/volume.h"

#include <cmath>
#include <map>

namespace arthronaut::images {

std::vector<std::pair<int, std::size_t>> labels_of(const Volume& volume) {
  std::map<int, std::size_t> counts;
  for (const float v : volume.values) {
    if (v != std::floor(v) || std::abs(v) > 1e6F) return {};
    ++counts[static_cast<int>(v)];
    if (counts.size() > 256) return {};
  }
  return {counts.begin(), counts.end()};
}

std::string axes_in_words(const Volume& volume) {
  constexpr const char* kWords[3][2] = {
      {"left", "right"}, {"posterior", "anterior"}, {"superior", "inferior"}};
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = volume.lps_from_index.linear().col(axis);
    Eigen::Index largest = 0;
    direction.cwiseAbs().maxCoeff(&largest);
    text += (axis > 0 ? "-" : "") + std::string(kWords[largest][direction[largest] < 0 ? 1 : 0]);
  }
  return text;
}

}  // namespace arthronaut::images
