#include "planning/landmarks/off_shape.h"

#include <algorithm>

namespace arthronaut::landmarks {

namespace {

double off_mm(const std::string& name, const Eigen::Vector3d& at_mm, const Landmarks& proposed) {
  const Eigen::Vector3d off = at_mm - proposed.at(name);
  const auto anterior = proposed.find("blumensaat_anterior");
  if (name != "blumensaat_posterior" || anterior == proposed.end()) return off.norm();
  const Eigen::Vector3d along = (anterior->second - proposed.at(name)).normalized();
  return (off - off.dot(along) * along).norm();
}

}  // namespace

std::optional<double> off_shape_mm(const std::string& name, const Eigen::Vector3d& at_mm,
                                   const Proposal& by_shape) {
  if (!by_shape.is_usable()) return std::nullopt;
  std::optional<double> nearest_mm;
  for (const Landmarks* proposed : {&by_shape.landmarks, &by_shape.by_other_roof}) {
    if (!proposed->contains(name)) continue;
    const double here_mm = off_mm(name, at_mm, *proposed);
    nearest_mm = std::min(nearest_mm.value_or(here_mm), here_mm);
  }
  return nearest_mm;
}

std::vector<OffShape> off_shape(const Landmarks& landmarks, const Proposal& by_shape) {
  std::vector<OffShape> all;
  for (const auto& [name, at_mm] : landmarks)
    if (const auto off_mm = off_shape_mm(name, at_mm, by_shape)) all.push_back({name, *off_mm, at_mm});
  std::ranges::stable_sort(all, std::ranges::greater{}, &OffShape::off_mm);
  return all;
}

}  // namespace arthronaut::landmarks
