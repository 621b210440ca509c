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

bool is_label_map(const Volume& volume) {
  if (volume.modality != Modality::Unknown) return false;
  const auto labels = labels_of(volume);
  if (labels.size() < 2 || labels.front().first < 0) return false;
  // A few thin labels, cartilage alone, may have more edge than inside; no image has so few grey values.
  constexpr std::size_t kFewLabels = 40;
  if (labels.size() <= kFewLabels) return true;
  // Of the pairs of neighbours that are not both background, which images have much of, too: of bones more
  // than 9 in 10 are alike, of noise of 3 grey values 1 in 10.
  constexpr double kLeastAlike = 0.5;
  std::size_t pairs = 0, alike = 0;
  const auto row = static_cast<std::size_t>(volume.size.x());
  for (std::size_t at = 1; at < volume.values.size(); ++at) {
    const float one = volume.values[at - 1], other = volume.values[at];
    if (at % row == 0 || (one == 0 && other == 0)) continue;
    ++pairs;
    alike += one == other ? 1 : 0;
  }
  return static_cast<double>(alike) >= kLeastAlike * static_cast<double>(pairs);
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
